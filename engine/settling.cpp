#include "engine/settling.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "base/reproducible_dot.h"
#include "engine/equilibrium.h"
#include "mesh/connected_nodes.h"
#include "solver/mass_clusters.h"
#include "solver/relax.h"

namespace trocar {

namespace {

constexpr double pull = 0.01;  // so little that strains tell of the undeformed body [m/s^2]

// Pieces that nothing holds along the axis (piece: of each node; held: held_components) would fall
// for ever: they stay where they are.
std::vector<PrescribedNode> nodes_at_rest(const Simulation& s, std::span<const std::int32_t> piece,
                                          std::span<const FixedMask> held, int axis) {
  std::vector<PrescribedNode> nodes = s.holds.prescribed;
  for (PrescribedNode& node : nodes) node.u_next = Vec3::Zero();
  for (std::int32_t i = 0; i < s.model.n_owned; ++i)
    if ((held[piece[s.part.node_global[i]]] >> axis & 1) == 0)
      nodes.push_back({.node = i, .u_next = Vec3::Zero()});
  return nodes;
}

// Supports bear a slender body's bending couple, which is many times the pull.
Relaxation relax_pulled(Simulation& s, int axis, std::span<const PrescribedNode> held,
                        State& state) {
  const Vec3 gravity = std::exchange(s.model.options.gravity, pull * Vec3::Unit(axis));
  const Relaxation found = relax(s.model,
                                 {.prescribed = held,
                                  .ramp_iterations = 0,
                                  .max_iterations = 20000,
                                  .tolerance = 1e-3,
                                  .neighbours = &s.neighbours},
                                 state, s.scratch);
  s.model.options.gravity = gravity;
  return found;
}

// How much slower the motion u is for masses that are scaled: u.I u / u.M u.
double share_of_inertia(const Simulation& s, std::span<const double> u) {
  // Asked of the whole body: a rank may have none of the scaled masses, and all sum up below.
  if (!s.mass_scaling || s.mass_scaling->n_clusters() == 0) return 1;
  const auto n = static_cast<std::int64_t>(s.communicator->all_sum(std::uint64_t{u.size()}));
  const auto dot = [&](const std::vector<double>& mass) {
    std::vector<double> momentum(u.size());
    for (std::size_t k = 0; k < u.size(); ++k) momentum[k] = mass[k / 3] * u[k];
    const double most =
        s.communicator->all_max(largest_size(u)) * s.communicator->all_max(largest_size(momentum));
    return reproducible_dot(u, momentum, n, most, *s.communicator);
  };
  const double of_mass = dot(s.model.mass);
  return of_mass > 0 ? dot(inertia_of(s.model)) / of_mass : 1;
}

// 1 / omega^2 of the slowest motion, at most: where all nodes follow a force on any of them, it is
// no more than the farthest one's way by the pull. [s^2]
double farthest_by_pull(const Simulation& s, std::span<const double> u) {
  double most = 0;
  for (std::size_t k = 0; k < u.size(); k += 3) most = std::max(most, Vec3::Map(&u[k]).norm());
  return s.communicator->all_max(most) / pull * share_of_inertia(s, u);
}

}  // namespace

double settling_time(Simulation& s) {
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  const std::vector<FixedMask> held = held_components(s, piece);
  if (std::ranges::count(held, 0) == std::ssize(held)) return 0;
  const auto n_owned = 3 * static_cast<std::size_t>(s.model.n_owned);
  double slowest = 0;  // 1 / omega^2
  for (int axis = 0; axis < 3; ++axis) {
    State state = make_state(s.model);
    if (!relax_pulled(s, axis, nodes_at_rest(s, piece, held, axis), state).is_converged)
      return longest_settling;
    slowest = std::max(slowest, farthest_by_pull(s, std::span(state.u).first(n_owned)));
  }
  constexpr double half_turn = 3.14, to_a_fifth = 1.6;
  return std::min(longest_settling, std::max(half_turn * std::sqrt(slowest),
                                             to_a_fifth * s.model.options.mass_damping * slowest));
}

}  // namespace trocar
