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
  int j;          // the other node
  double length;  // spring: l; particles: r0^2
};
// Pairs of node i, each pair once: pair[k] for end of the node before <= k < end.
struct NodePairs {
  int i, end;
};
struct Pairs {
  std::vector<PlanePair> pair;
  std::vector<NodePairs> node;
};
struct Network {
  Pairs springs, particles;
};

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

// Of the edges at each node.
std::vector<double> mean_edges(const PlanePatch& patch, const PlaneNeighbours& around) {
  std::vector<double> mean(patch.node.size());
  for (int i = 0; i < patch.n_nodes(); ++i) {
    double sum = 0;
    for (const int j : around.of(i)) sum += (patch.X[j] - patch.X[i]).norm();
    mean[i] = sum / static_cast<double>(around.of(i).size());
  }
  return mean;
}

void end_node(int i, Pairs& pairs) {
  pairs.node.push_back({i, static_cast<int>(pairs.pair.size())});
}

Network make_network(const PlanePatch& patch, std::span<const Movable> movable) {
  const PlaneNeighbours around = all_neighbours(patch);
  const std::vector<double> mean = mean_edges(patch, around);
  std::vector<int> last(patch.node.size(), -1);
  std::vector<std::uint8_t> is_done(patch.node.size(), 0);  // all its pairs are there
  Network network;
  network.springs.pair.reserve(4 * movable.size());
  network.particles.pair.reserve(14 * movable.size());
  for (const auto& [i, side] : movable) {
    for (const int j : around.of(i))
      if (is_done[j] == 0) network.springs.pair.push_back({j, (patch.X[j] - patch.X[i]).norm()});
    visit_two_rings(around, i, last, [&](int j) {
      const double r0 = 0.5 * (mean[i] + mean[j]);
      if (is_done[j] == 0) network.particles.pair.push_back({j, r0 * r0});
    });
    is_done[i] = 1;
    end_node(i, network.springs);
    end_node(i, network.particles);
  }
  return network;
}

// Adds factor(d, length) d to the first node's force and takes it from the other's, d from the
// other node to the first.
template <typename Factor>
void add_forces(const PlanePatch& patch, const Pairs& pairs, std::vector<Vec2>& force,
                Factor factor) {
  int k = 0;
  for (const auto& [i, end] : pairs.node) {
    const Vec2 x = patch.x[i];
    Vec2 sum = force[i];
    for (; k < end; ++k) {
      const auto& [j, length] = pairs.pair[k];
      const Vec2 d = x - patch.x[j], f = factor(d.squaredNorm(), length) * d;
      sum += f;
      force[j] -= f;
    }
    force[i] = sum;
  }
}

void add_springs(const PlanePatch& patch, const Pairs& springs, double scale,
                 std::vector<Vec2>& force) {
  add_forces(patch, springs, force, [scale](double r2, double length) {
    const double r = std::sqrt(r2);
    return r > 0 ? -spring(scale, r, length) : 0;
  });
}

void add_particles(const PlanePatch& patch, const Pairs& particles, const CutPlaneOptions& options,
                   std::vector<Vec2>& force) {
  add_forces(patch, particles, force,
             LennardJones{options.repulsion, options.attraction, options.particle});
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

bool is_any_squeezed(const PlanePatch& patch) {
  for (int e = 0; e < patch.n_elements(); ++e)
    if (area(patch, e) < least_area * patch.area[e]) return true;
  return false;
}

// Undoing one node may squeeze another element, so until nothing changes; at worst all go back.
void take_back_squeezed(PlanePatch& patch, std::span<const Movable> movable,
                        const std::vector<Vec2>& before) {
  for (bool is_changed = is_any_squeezed(patch); is_changed;) {
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
  std::vector<Vec2> before(movable.size());
  for (std::size_t slot = 0; slot < movable.size(); ++slot)
    before[slot] = patch.x[movable[slot].node];
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
    add_springs(patch, network.springs, options.spring, force);
    if (options.particle > 0) add_particles(patch, network.particles, options, force);
    if (take_step(patch, movable, force) < options.threshold * patch.h) return;
  }
}

}  // namespace trocar
