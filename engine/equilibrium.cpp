#include "engine/equilibrium.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number_text.h"
#include "base/timers.h"
#include "engine/event_log.h"
#include "engine/frame_force.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "engine/instrument_check.h"
#include "mesh/connected_nodes.h"
#include "solver/relax.h"

namespace trocar {

namespace {

[[noreturn]] void give_up(Simulation& s, const std::string& cause) {
  s.state = make_state(s.model);
  throw SimulationError("no equilibrium to start from: " + cause +
                        "; supports may leave the body free to turn, or it is too soft to bear "
                        "its weight" +
                        (s.loads.is_empty() ? "" : " and loads"));
}

Relaxation relax_body(Simulation& s, const std::atomic<bool>* stop) {
  aim_holds(s.holds, s.tools, s.mesh.X, 0);
  const auto add = [&](double share, std::span<double> force) {
    find_loads_at(s, 0);
    add_loads(s.loads, share, force);
  };
  return relax(s.model,
               {.add_load = add,
                .prescribed = s.holds.prescribed,
                .max_iterations = s.scene.start.max_iterations,
                .tolerance = s.scene.start.tolerance,
                .neighbours = &s.neighbours,
                .stop = stop},
               s.state, s.scratch);
}

void check_found(const Relaxation& found, Simulation& s) {
  const std::string n = std::to_string(found.iterations);
  if (!found.is_finite) give_up(s, "the relaxation diverged after " + n + " iterations");
  if (!found.is_converged)
    give_up(s, "after " + n + " iterations (start.max_iterations) the residual is " +
                   short_text(found.residual) + ", above start.tolerance");
  watch_state(s);
  const std::string trouble = find_trouble(s);
  if (!trouble.empty()) give_up(s, trouble);
}

// Of loads with a direction, all together; of pieces nobody knows which bears what.
void check_loads_are_held(std::span<const FixedMask> held, const Simulation& s,
                          OptionErrors& errors) {
  constexpr double least_share = 1e-9;
  Vec3 sum = Vec3::Zero();
  double size = 0;
  for (const SceneLoad& load : s.scene.loads) {
    const double factor = load.path.empty() ? 1 : load.path.front().factor;
    sum += factor * load.force;
    size += std::abs(factor) * load.force.norm();
  }
  for (int j = 0; j < 3; ++j)
    if (std::abs(sum[j]) > least_share * size &&
        std::ranges::none_of(held, [&](FixedMask mask) { return (mask >> j & 1) != 0; }))
      errors.add("start.state", std::string("there is no equilibrium: no support holds the "
                                            "body along ") +
                                    "xyz"[j] + ", and loads move it there");
}

}  // namespace

std::vector<FixedMask> held_components(const Simulation& s, std::span<const std::int32_t> piece) {
  std::vector<FixedMask> held(piece.size(), 0);
  const auto hold = [&](std::size_t node, FixedMask mask) {
    FixedMask& of_piece = held[piece[node]];
    of_piece = static_cast<FixedMask>(of_piece | mask);
  };
  for (std::size_t node = 0; node < piece.size(); ++node) hold(node, s.fixed[node]);
  for (const Hold& moved : s.holds.holds)
    hold(static_cast<std::size_t>(moved.node), all_components);
  return held;
}

void check_is_held(const Simulation& s, OptionErrors& errors) {
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  const std::vector<FixedMask> held = held_components(s, piece);
  const Vec3& gravity = s.scene.solver.gravity;
  check_loads_are_held(held, s, errors);
  for (std::size_t node = 0; node < piece.size(); ++node)
    for (int j = 0; j < 3; ++j)
      if (piece[node] == static_cast<std::int32_t>(node) && gravity[j] != 0 &&
          (held[node] >> j & 1) == 0)
        return errors.add("start.state",
                          "there is no equilibrium: no support holds the piece of the body with "
                          "node " +
                              std::to_string(node) + " along " + "xyz"[j] +
                              ", and gravity moves it there");
}

bool start_in_equilibrium(const LoadedScene& loaded, Simulation& s, const std::atomic<bool>* stop) {
  const double start = monotonic_seconds();
  const Relaxation found = relax_body(s, stop);
  if (found.is_stopped) {
    s.state = make_state(s.model);
    return false;
  }
  check_found(found, s);
  s.log.equilibrium = {.iterations = found.iterations,
                       .residual = found.residual,
                       .seconds = monotonic_seconds() - start};
  if (s.contact) {
    refresh_surface(s);
    check_instruments_outside(loaded, 0,
                              "the body in equilibrium, which is found without instruments: let it "
                              "begin outside, or start with state = \"undeformed\"",
                              s);
  }
  s.log.least_J = s.watch.least_J;
  s.log.least_J_element = s.watch.least_J_element;
  s.log.least_stable_step = s.log.largest_stable_step = s.watch.stable_step;
  if (s.energy) open_energy_ledger(s);
  note_event(s, 0,
             "in equilibrium after " + std::to_string(found.iterations) + " iterations, residual " +
                 short_text(found.residual));
  return true;
}

}  // namespace trocar
