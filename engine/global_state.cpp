#include "engine/global_state.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/simulation.h"

namespace trocar {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// u, v: the three components of the node.
void set_node(std::int32_t node, const Vec3& X, const double* u, const double* v,
              GlobalState& global) {
  const auto i = static_cast<std::size_t>(node);
  std::copy_n(u, 3, &global.u[3 * i]);
  std::copy_n(v, 3, &global.v[3 * i]);
  global.x[i] = X + Vec3::Map(u);
}

}  // namespace

GlobalState gather_state(Simulation& s) {
  GlobalState global;
  forget_state(s.mesh.X.size(), global);
  find_all_nodes(s, global);
  return global;
}

void forget_state(std::size_t n_nodes, GlobalState& global) {
  constexpr double nowhere[] = {unknown, unknown, unknown};
  for (const std::int32_t i : global.known) {
    set_node(i, Vec3::Zero(), nowhere, nowhere, global);
    global.is_known[i] = 0;
  }
  global.known.clear();
  global.u.resize(3 * n_nodes, unknown);
  global.v.resize(3 * n_nodes, unknown);
  global.x.resize(n_nodes, Vec3::Constant(unknown));
  global.is_known.resize(n_nodes, 0);
}

std::vector<double> motion_at(const Simulation& s, std::span<const std::int32_t> nodes,
                              const Communicator& ranks) {
  std::vector<double> mine;
  std::vector<std::size_t> next(static_cast<std::size_t>(s.communicator->size()) + 1, 0);
  const auto owner = [&](std::int32_t i) { return static_cast<std::size_t>(s.node_owner[i]); };
  for (const std::int32_t i : nodes) {
    next[owner(i) + 1] += 6;
    if (std::cmp_not_equal(owner(i), s.communicator->rank())) continue;
    const auto local = 3 * static_cast<std::size_t>(s.part.node_local[i]);
    mine.insert(mine.end(), &s.state.u[local], &s.state.u[local] + 3);
    mine.insert(mine.end(), &s.state.v[local], &s.state.v[local] + 3);
  }
  const std::vector<double> by_owner =
      ranks.all_gather(mine);  // in their order, which is the world's
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<double> motion;
  motion.reserve(by_owner.size());
  for (const std::int32_t i : nodes) {
    const double* const from = &by_owner[next[owner(i)]];
    motion.insert(motion.end(), from, from + 6);
    next[owner(i)] += 6;
  }
  return motion;
}

void find_nodes(const Simulation& s, std::span<const std::int32_t> nodes, const Communicator& ranks,
                GlobalState& global) {
  const std::size_t n_known = global.known.size();
  for (const std::int32_t i : nodes) {
    if (std::exchange(global.is_known[i], 1) == 0) global.known.push_back(i);
  }
  const std::span asked = std::span(global.known).subspan(n_known);
  if (asked.empty()) return;
  const std::vector<double> motion = motion_at(s, asked, ranks);
  for (std::size_t k = 0; k < asked.size(); ++k)
    set_node(asked[k], s.mesh.X[asked[k]], &motion[6 * k], &motion[6 * k + 3], global);
}

void find_all_nodes(Simulation& s, GlobalState& global) {
  const PhaseScope scope(s.timers, phase_gather);
  const std::vector<double> u = all_gather_field(s.part, 3, s.state.u, *s.communicator);
  const std::vector<double> v = all_gather_field(s.part, 3, s.state.v, *s.communicator);
  for (std::size_t i = 0; i < s.part.node_local.size(); ++i) {
    if (std::exchange(global.is_known[i], 1) != 0) continue;
    const auto node = static_cast<std::int32_t>(i);
    global.known.push_back(node);
    set_node(node, s.mesh.X[i], &u[3 * i], &v[3 * i], global);
  }
}

void scatter_state(Simulation& s, const GlobalState& global) {
  s.scratch.has_force = false;
  State state = make_state(s.model);
  state.time = s.state.time;
  state.last_dt = s.state.last_dt;
  state.step = s.state.step;
  state.history_time = s.state.history_time;
  state.u = scatter_field(s.part, 3, global.u, s.part.n_local());
  state.v = scatter_field(s.part, 3, global.v, s.part.n_local());
  s.state = std::move(state);
}

void scatter_edited(Simulation& s, std::size_t n_kept, std::span<const std::int32_t> nodes,
                    const GlobalState& global) {
  s.scratch.has_force = false;  // on ranks that have nothing of the edit, too: all exchange alike
  State& state = s.state;
  state.u.resize(3 * s.part.node_global.size());
  state.v.resize(3 * s.part.node_global.size());
  const auto n_owned = static_cast<std::size_t>(s.part.n_owned);
  const auto take = [&](std::size_t local) {
    const auto from = 3 * static_cast<std::size_t>(s.part.node_global[local]);
    std::copy_n(&global.u[from], 3, &state.u[3 * local]);
    std::copy_n(&global.v[from], 3, &state.v[3 * local]);
  };
  for (const std::int32_t i : nodes)
    if (const std::int32_t local = s.part.owned(i); local >= 0)
      take(static_cast<std::size_t>(local));
  for (std::size_t local = n_kept; local < n_owned; ++local) take(local);
  start_exchange(s.neighbours, state);
  finish_exchange(s.neighbours, state);
  const auto n_fields = static_cast<std::size_t>(s.model.averages.n_fields);
  state.theta.assign(s.part.node_global.size() * n_fields, 0.0);
}

}  // namespace trocar
