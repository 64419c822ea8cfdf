#include "cutting/cut_plane_homogenise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/cut_pair_forces.h"

namespace trocar {

namespace {

using namespace pair_forces;

constexpr double least_area = 0.1;  // of the area before the cut

// Both ends feel a pair; what nodes that stay feel is not used.
struct PlanePair {
  int i, j;       // nodes
  double length;  // spring: l; particles: r0^2
};
struct Network {
  std::vector<PlanePair> springs, particles;
};

double mean_edge(const PlanePatch& patch, std::span<const int> around, int node) {
  double sum = 0;
  for (const int j : around) sum += (patch.X[j] - patch.X[node]).norm();
  return sum / static_cast<double>(around.size());
}

// Calls visit for the nodes two edges away and nearer, once each; `last` holds for whom a node was
// visited last. Neighbours by topology never see across an older cut.
template <typename Visit>
void visit_two_rings(const PlaneNeighbours& around, int node, std::vector<int>& last, Visit visit) {
  last[node] = node;
  for (const int j : around.of(node)) {
    if (std::exchange(last[j], node) != node) visit(j);
    for (const int k : around.of(j))
      if (std::exchange(last[k], node) != node) visit(k);
  }
}

Network make_network(const PlanePatch& patch, std::span<const Movable> movable) {
  const PlaneNeighbours around = all_neighbours(patch);
  std::vector<double> mean;
  for (int i = 0; i < patch.n_nodes(); ++i) mean.push_back(mean_edge(patch, around.of(i), i));
  std::vector<int> last(patch.node.size(), -1);
  std::vector<std::uint8_t> is_done(patch.node.size(), 0);  // all its pairs are there
  Network network;
  for (const auto& [i, side] : movable) {
    for (const int j : around.of(i))
      if (is_done[j] == 0) network.springs.push_back({i, j, (patch.X[j] - patch.X[i]).norm()});
    visit_two_rings(around, i, last, [&](int j) {
      const double r0 = 0.5 * (mean[i] + mean[j]);
      if (is_done[j] == 0) network.particles.push_back({i, j, r0 * r0});
    });
    is_done[i] = 1;
  }
  return network;
}

void add_springs(const PlanePatch& patch, const Network& network, double scale,
                 std::vector<Vec2>& force) {
  for (const auto& [i, j, length] : network.springs) {
    const Vec2 d = patch.x[j] - patch.x[i];
    const double r = d.norm();
    if (!(r > 0)) continue;
    const Vec2 f = spring(scale, r, length) * d;
    force[i] += f;
    force[j] -= f;
  }
}

void add_particles(const PlanePatch& patch, const Network& network, const CutPlaneOptions& options,
                   std::vector<Vec2>& force) {
  const LennardJones repel{options.repulsion, options.attraction, options.particle};
  for (const auto& [i, j, r0_squared] : network.particles) {
    const Vec2 d = patch.x[i] - patch.x[j], f = repel(d.squaredNorm(), r0_squared) * d;
    force[i] += f;
    force[j] -= f;
  }
}

// Moves a node by at most `longest_step` h, along its side if it is bound to one.
void move_node(PlanePatch& patch, const Movable& m, const Vec2& force) {
  Vec2 step = gain * force;
  const double most = longest_step * patch.h, length = step.norm();
  if (length > most) step *= most / length;
  if (m.side.squaredNorm() > 0) step = m.side.dot(step) * m.side;
  patch.x[m.node] += step;
}

bool is_squeezed(const PlanePatch& patch, int node) {
  bool result = false;
  visit_star(patch, node, [&](int e, int) {
    result = area(patch, e) < least_area * patch.area[e];
    return !result;
  });
  return result;
}

// Undoing one node may squeeze another element, so until nothing changes; at worst all go back.
void take_back_squeezed(PlanePatch& patch, std::span<const Movable> movable,
                        const std::vector<Vec2>& before) {
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (std::size_t slot = 0; slot < movable.size(); ++slot) {
      const int i = movable[slot].node;
      if (patch.x[i] == before[slot] || !is_squeezed(patch, i)) continue;
      patch.x[i] = before[slot];
      is_changed = true;
    }
  }
}

// Returns the largest displacement.
double take_step(PlanePatch& patch, std::span<const Movable> movable,
                 const std::vector<Vec2>& force) {
  std::vector<Vec2> before;
  for (const Movable& m : movable) before.push_back(patch.x[m.node]);
  for (std::size_t slot = 0; slot < movable.size(); ++slot)
    move_node(patch, movable[slot], force[movable[slot].node]);
  take_back_squeezed(patch, movable, before);
  double largest = 0;
  for (std::size_t slot = 0; slot < movable.size(); ++slot)
    largest = std::max(largest, (patch.x[movable[slot].node] - before[slot]).squaredNorm());
  return std::sqrt(largest);
}

}  // namespace

void homogenise(PlanePatch& patch, std::span<const Movable> movable,
                const CutPlaneOptions& options) {
  if (options.most_steps < 1) return;
  const Network network = make_network(patch, movable);
  std::vector<Vec2> force;
  for (int step = 0; step < options.most_steps; ++step) {
    force.assign(patch.node.size(), Vec2::Zero());
    add_springs(patch, network, options.spring, force);
    if (options.particle > 0) add_particles(patch, network, options, force);
    if (take_step(patch, movable, force) < options.threshold * patch.h) return;
  }
}

}  // namespace trocar
