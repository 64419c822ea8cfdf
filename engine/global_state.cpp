#include "engine/global_state.h"

#include "base/components.h"
#include "engine/simulation.h"

namespace trocar {

void gather_positions(Simulation& s, GlobalState& global) {
  const PhaseScope scope(s.timers, phase_gather);
  const std::vector<Vec3>& X = s.mesh.X;
  all_gather_field(s.part, 3, s.state.u, *s.communicator, global.u);
  global.x.resize(X.size());
  components(global.x) =
      components(X) + Eigen::Map<const Eigen::ArrayXd>(global.u.data(), std::ssize(global.u));
  global.has_velocities = false;
}

void gather_velocities(Simulation& s, GlobalState& global) {
  const PhaseScope scope(s.timers, phase_gather);
  all_gather_field(s.part, 3, s.state.v, *s.communicator, global.v);
  global.has_velocities = true;
}

GlobalState gather_state(Simulation& s) {
  GlobalState global;
  gather_positions(s, global);
  gather_velocities(s, global);
  return global;
}

void scatter_state(Simulation& s, const GlobalState& global) {
  s.scratch.has_force = false;
  State state = make_state(s.model);
  state.time = s.state.time;
  state.last_dt = s.state.last_dt;
  state.step = s.state.step;
  state.history_time = s.state.history_time;
  for (std::size_t i = 0; i < s.part.node_global.size(); ++i) {
    const auto g = static_cast<std::size_t>(s.part.node_global[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      state.u[3 * i + k] = global.u[3 * g + k];
      state.v[3 * i + k] = global.v[3 * g + k];
    }
  }
  s.state = std::move(state);
}

}  // namespace trocar
