#include "cutting/cut_plane_homogenise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/cut_pair_forces.h"

namespace trocar {

namespace {

using namespace pair_forces;

constexpr double least_area = 0.1;  // of the area before the cut

using Two = Eigen::Array2d;  // a number of each of two pairs

// Pairs of nodes; both ends feel one, but what nodes that stay feel is not used. Those of the k-th
// movable node are first[k] <= p < first[k + 1], each pair once.
struct Pairs {
  std::vector<int> first{0};
  std::vector<int> other;
  std::vector<double> length;  // springs: l; particles: r0^2
  int size() const { return static_cast<int>(other.size()); }
  void add(int node, double l) {
    other.push_back(node);
    length.push_back(l);
  }
  void reserve(std::size_t n) {
    other.reserve(n);
    length.reserve(n + 1);
  }
};
struct Network {
  Pairs springs, particles;
};

// Calls visit for the nodes two edges away and nearer, once each; `last` holds for whom a node was
// visited last. Neighbours by topology never see across an older cut.
template <typename Visit>
void visit_two_rings(const Grouped<int>& around, int node, std::vector<int>& last, Visit visit) {
  last[node] = node;
  for (const int j : around.of(node)) {
    if (std::exchange(last[j], node) != node) visit(j);
    for (const int k : around.of(j))
      if (std::exchange(last[k], node) != node) visit(k);
  }
}

// Of the edges at each node.
std::vector<double> mean_edges(const PlanePatch& patch, const Grouped<int>& around) {
  std::vector<double> mean(patch.node.size());
  for (int i = 0; i < patch.n_nodes(); ++i) {
    double sum = 0;
    for (const int j : around.of(i)) sum += (patch.X[j] - patch.X[i]).norm();
    mean[i] = sum / static_cast<double>(around.of(i).size());
  }
  return mean;
}

Network make_network(const PlanePatch& patch, std::span<const Movable> movable) {
  const Grouped<int> around = all_neighbours(patch);
  const std::vector<double> mean = mean_edges(patch, around);
  std::vector<int> last(patch.node.size(), -1);
  std::vector<std::uint8_t> is_done(patch.node.size(), 0);  // all its pairs are there
  Network network;
  network.springs.reserve(5 * movable.size());
  network.particles.reserve(16 * movable.size());
  for (const auto& [i, side] : movable) {
    for (const int j : around.of(i))
      if (is_done[j] == 0) network.springs.add(j, (patch.X[j] - patch.X[i]).norm());
    visit_two_rings(around, i, last, [&](int j) {
      if (is_done[j] != 0) return;
      const double r0 = 0.5 * (mean[i] + mean[j]);
      network.particles.add(j, r0 * r0);
    });
    is_done[i] = 1;
    for (Pairs* pairs : {&network.springs, &network.particles})
      pairs->first.push_back(pairs->size());
  }
  for (Pairs* pairs : {&network.springs, &network.particles})
    pairs->length.push_back(1);  // beside the last one
  return network;
}

// Adds factor(r^2, length) d to the force of each movable node and takes it from the other one's, d
// from the other node.
template <typename Factor>
void add_forces(const PlanePatch& patch, std::span<const Movable> movable, const Pairs& pairs,
                Factor factor, std::vector<Vec2>& force) {
  for (std::size_t slot = 0; slot < movable.size(); ++slot) {
    const Vec2 x = patch.x[movable[slot].node];
    Vec2 sum = force[movable[slot].node];
    const int end = pairs.first[slot + 1];
    for (int p = pairs.first[slot]; p < end; p += 2) {
      const int j = pairs.other[p], k = pairs.other[p + 1 < end ? p + 1 : p];
      const Vec2 d = x - patch.x[j], e = x - patch.x[k];
      const Two dx(d.x(), e.x()), dy(d.y(), e.y());
      const Two c = factor(Two(dx * dx + dy * dy), Two(Eigen::Map<const Two>(&pairs.length[p])));
      const Vec2 f = c[0] * d;
      sum += f;
      force[j] -= f;
      if (p + 1 == end) continue;
      const Vec2 g = c[1] * e;
      sum += g;
      force[k] -= g;
    }
    force[movable[slot].node] = sum;
  }
}

// As pair_forces::spring.
struct Springs {
  double scale;
  Two operator()(const Two& r2, const Two& length) const {
    const Two r = r2.sqrt(), c = -(scale * (1 - length / r));
    return (r > 0).select(c, Two::Zero());
  }
};

// As pair_forces::LennardJones, whose usual exponents are computed for two pairs at once.
struct Particles {
  LennardJones one;
  Two operator()(const Two& r2, const Two& r0_squared) const {
    if (one.n != 12 || one.m != 6) return {one(r2[0], r0_squared[0]), one(r2[1], r0_squared[1])};
    const Two rho = (r0_squared / r2).min(largest_rho), cube = rho * (rho * rho);
    const Two c = one.scale / 6 * ((rho * rho) * (rho * rho)) * (cube - 1);
    return (r2 > cut_off_squared * r0_squared).select(Two::Zero(), c);
  }
};

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
  const Particles particles{{options.repulsion, options.attraction, options.particle}};
  std::vector<Vec2> force;
  for (int step = 0; step < options.most_steps; ++step) {
    force.assign(patch.node.size(), Vec2::Zero());
    add_forces(patch, movable, network.springs, Springs{options.spring}, force);
    if (options.particle > 0) add_forces(patch, movable, network.particles, particles, force);
    if (take_step(patch, movable, force) < options.threshold * patch.h) return;
  }
}

}  // namespace trocar
