// W(u - t d) is close to a parabola: d is the gradient over the stiffness at each node, so that a
// step of 1 lowers the energy whatever the elements' shapes.
#include "engine/apply_cut_energy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/sort_unique.h"
#include "engine/apply_cut_momentum.h"
#include "solver/relax.h"
#include "solver/step.h"
#include "solver/watch.h"

namespace trocar {

namespace {

constexpr int most_rounds = 30;
constexpr int most_rings = 3;
constexpr int most_halvings = 5;
constexpr double farthest_up = 1, farthest_down = 3;  // t of a round
constexpr double least_J_ratio = 0.5;

// From u0 along -d the energy falls with `slope`.
struct Line {
  std::vector<double> u0, d;  // (n_nodes * 3)
  double slope = 0;
};

// `stiffness` (n_nodes of the body): no mode of the body is stiffer than it.
Line find_line(std::span<const std::int32_t> nodes, std::span<const double> stiffness,
               RankBody& body) {
  average_volume_change(body.model, body.state, body.scratch);
  compute_force(body.model, body.state, body.scratch);
  Line line;
  for (const std::int32_t i : nodes)
    for (int j = 0; j < 3; ++j) {
      const auto k = static_cast<std::size_t>(3 * i + j);
      const auto node = static_cast<std::size_t>(i);
      const double gradient =
          is_fixed(body.model, i, j)
              ? 0
              : body.model.mass[node] * body.model.options.gravity[j] - body.scratch.force[k];
      line.u0.push_back(body.state.u[k]);
      line.d.push_back(gradient / stiffness[node]);
      line.slope += gradient * line.d.back();
    }
  return line;
}

double energy_at(double t, std::span<const std::int32_t> nodes, const Line& line, RankBody& body) {
  for (std::size_t k = 0; k < line.d.size(); ++k)
    body.state.u[3 * static_cast<std::size_t>(nodes[k / 3]) + k % 3] = line.u0[k] - t * line.d[k];
  return strain_energy(body);
}

// Where the parabola of this slope that has risen by `rise` at `at` has fallen by `fall`, or its
// lowest point.
double place_of(double fall, double slope, double at, double rise) {
  const double c = (rise + slope * at) / (at * at);
  const double square = slope * slope - 4 * c * fall;
  const double t = square > 0 ? 2 * fall / (slope + std::sqrt(square)) : slope / (2 * c);
  return std::clamp(t, -farthest_up, farthest_down);
}

// One round from energy W; the new one, or W where none is nearer.
double step_towards(double wanted, double least_J, double W, std::span<const std::int32_t> nodes,
                    std::span<const double> stiffness, RankBody& body) {
  const Line line = find_line(nodes, stiffness, body);
  if (!(line.slope > 0)) return W;
  const double first = std::clamp((W - wanted) / line.slope, -farthest_up, 1.0);
  double t = place_of(W - wanted, line.slope, first, energy_at(first, nodes, line, body) - W);
  for (int k = 0; k < most_halvings; ++k, t /= 2) {
    const double now = energy_at(t, nodes, line, body);
    if (std::abs(now - wanted) < std::abs(W - wanted) &&
        watch(body.model, body.part, body.state).least_J >= least_J)
      return now;
  }
  return energy_at(0, nodes, line, body);
}

}  // namespace

double strain_energy(RankBody& body) {
  average_volume_change(body.model, body.state, body.scratch);
  EnergyTerms terms;
  energy_terms(body.model, body.part, body.state, terms);
  double sum = 0;
  for (const std::vector<double>* list : {&terms.strain, &terms.volumetric, &terms.hourglass})
    sum = std::accumulate(list->begin(), list->end(), sum);
  return sum;
}

std::vector<std::int32_t> adjustable_nodes(const Simulation& s, const MeshEdit& edit) {
  std::vector<std::int32_t> nodes = moved_nodes(edit);
  for (const ElementSplit& split : edit.splits)
    nodes.insert(nodes.end(), s.mesh.corners(split.element).begin(),
                 s.mesh.corners(split.element).end());
  for (std::size_t k = 0; k < edit.n_new_nodes(); ++k)
    nodes.push_back(s.mesh.n_nodes() + static_cast<std::int32_t>(k));
  sort_unique(nodes);
  std::erase_if(nodes, [&](std::int32_t i) { return is_immovable(s.holds, s.fixed, i, edit); });
  return nodes;
}

std::unique_ptr<Patch> make_strained_patch(const Simulation& s, const MeshEdit& edit,
                                           std::span<const std::int32_t> edited,
                                           std::span<const std::int32_t> nodes,
                                           GlobalState& global) {
  const bool averages = s.model.options.tet4 == Formulation::tet4_nodal_pressure;
  if (edit.splits.empty() && !averages) return make_patch_of(s, edited, {.global = global});
  return make_patch_of(s, elements_of_forces(s, nodes), {.global = global});
}

double restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, double tolerance,
                             RankBody& body) {
  double W = strain_energy(body);
  if (std::abs(W - wanted) <= tolerance) return W - wanted;
  const double least_J = least_J_ratio * watch(body.model, body.part, body.state).least_J;
  std::vector<double> stiffness = relaxation_mass(body.model);
  for (double& k : stiffness) k *= 4;  // of the highest frequency 2 / step, step 1
  for (int round = 0; round < most_rounds && std::abs(W - wanted) > tolerance; ++round) {
    const double before = W;
    W = step_towards(wanted, least_J, W, nodes, stiffness, body);
    if (W == before) break;
  }
  return W - wanted;
}

double restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, double tolerance,
                             const Mesh& mesh, Patch& patch, GlobalState& global) {
  std::vector<std::int32_t> local;
  for (const std::int32_t i : nodes) local.push_back(place_in(patch.sub.node, i));
  const double surplus = restore_strain_energy(local, wanted, tolerance, patch);
  for (std::size_t k = 0; k < local.size(); ++k) {
    const auto i = static_cast<std::size_t>(nodes[k]);
    std::copy_n(&patch.state.u[3 * static_cast<std::size_t>(local[k])], 3, &global.u[3 * i]);
    global.x[i] = mesh.X[i] + Vec3::Map(&global.u[3 * i]);
  }
  return surplus;
}

TakenUp take_up_around(Simulation& s, std::span<const std::int32_t> nodes, double surplus,
                       double tolerance, GlobalState& global, CutRecord& record) {
  TakenUp taken{.nodes = {}, .surplus = surplus};
  if (std::abs(surplus) <= tolerance) return taken;
  taken.nodes.assign(nodes.begin(), nodes.end());
  for (int ring = 0; ring < most_rings && std::abs(taken.surplus) > tolerance; ++ring) {
    taken.nodes = nodes_of(s.mesh, elements_around(s.corners, taken.nodes));
    std::vector<std::int32_t> movable = taken.nodes;
    std::erase_if(movable, [&](std::int32_t i) { return is_immovable(s.holds, s.fixed, i); });
    const std::unique_ptr<Patch> patch =
        make_patch_of(s, elements_of_forces(s, taken.nodes), {.global = global});
    const auto energy = [&] {
      return s.energy ? patch_energy(s, taken.nodes, {.global = global}) : 0.0;
    };
    const double before = energy();
    const Motion motion = motion_about_centre(taken.nodes, s.mass, global);
    const double wanted = strain_energy(*patch) - taken.surplus;
    taken.surplus = restore_strain_energy(movable, wanted, tolerance, s.mesh, *patch, global);
    restore_motion({taken.nodes, movable, s.mass, s.fixed, s.holds.holds}, motion, global, record);
    taken.energy += energy() - before;
  }
  return taken;
}

}  // namespace trocar
