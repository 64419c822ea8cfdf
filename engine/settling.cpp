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

// Strains stay so small that they tell of the undeformed body.
const Vec3 pull = Vec3::Constant(0.01);  // [m/s^2]

// Pieces that nothing holds (piece: of each node; held: held_components) would fall for ever: they
// stay where they are.
std::vector<PrescribedNode> nodes_at_rest(const Simulation& s, std::span<const std::int32_t> piece,
                                          std::span<const FixedMask> held) {
  std::vector<PrescribedNode> nodes = s.holds.prescribed;
  for (PrescribedNode& node : nodes) node.u_next = Vec3::Zero();
  for (std::int32_t i = 0; i < s.model.n_owned; ++i)
    if (held[piece[s.part.node_global[i]]] == 0)
      nodes.push_back({.node = i, .u_next = Vec3::Zero()});
  return nodes;
}

Relaxation relax_pulled(Simulation& s, std::span<const PrescribedNode> held, State& state) {
  const Vec3 gravity = std::exchange(s.model.options.gravity, pull);
  const Relaxation found = relax(s.model,
                                 {.prescribed = held,
                                  .ramp_iterations = 0,
                                  .max_iterations = 20000,
                                  .tolerance = 0.01,
                                  .neighbours = &s.neighbours},
                                 state, s.scratch);
  s.model.options.gravity = gravity;
  s.scratch.has_force = false;
  return found;
}

// u.M pull / u.M u: the static answer to a force M pull has u.K u = u.M pull.
double rayleigh_quotient(const Simulation& s, std::span<const double> u) {
  std::vector<double> pulled(u.size()), momentum(u.size());
  const std::vector<double>& mass = inertia_of(s.model);
  for (std::size_t k = 0; k < u.size(); ++k) {
    pulled[k] = s.model.mass[k / 3] * pull[static_cast<Eigen::Index>(k % 3)];
    momentum[k] = mass[k / 3] * u[k];
  }
  const auto n = static_cast<std::int64_t>(s.communicator->all_sum(std::uint64_t{u.size()}));
  const auto dot = [&](std::span<const double> with) {
    const double most =
        s.communicator->all_max(largest_size(u)) * s.communicator->all_max(largest_size(with));
    return reproducible_dot(u, with, n, most, *s.communicator);
  };
  const double inertia = dot(momentum);
  return inertia > 0 ? dot(pulled) / inertia : 0;
}

}  // namespace

double settling_time(Simulation& s) {
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  const std::vector<FixedMask> held = held_components(s, piece);
  if (std::ranges::count(held, 0) == std::ssize(held)) return 0;
  State state = make_state(s.model);
  if (!relax_pulled(s, nodes_at_rest(s, piece, held), state).is_converged) return 0;
  const auto n_owned = 3 * static_cast<std::size_t>(s.model.n_owned);
  const double omega2 = rayleigh_quotient(s, std::span(state.u).first(n_owned));
  if (!(omega2 > 0)) return 0;
  constexpr double half_turn = 3.14, to_a_fifth = 1.6;
  return std::max(half_turn / std::sqrt(omega2),
                  to_a_fifth * s.model.options.mass_damping / omega2);
}

}  // namespace trocar
