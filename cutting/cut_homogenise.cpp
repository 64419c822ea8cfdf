// Forces of all pairs at a time, then node by node in ascending order.
#include "cutting/cut_homogenise.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "cutting/cut_pair_forces.h"

namespace trocar {

using namespace pair_forces;

static constexpr int most_steps = 60;
static constexpr int steps_a_round = 15;   // between two displacements of nodes left behind
static constexpr double at_rest = 1e-3;    // of h: the largest motion of a step that ends it
static constexpr double spring_scale = 1;  // as in the plane
static constexpr LennardJones repel{12, 6, 0.1};

namespace {

// Node i and another one of the patch.
struct Pair {
  std::int32_t i, other;
  double length;  // spring: l; particles: r0^2
};

struct System {
  const CutSurroundings& around;
  const std::vector<NodeRole>& role;
  double least_step = 0;
  std::vector<Vec3>& X;
  std::vector<std::int32_t> movable;
  std::vector<Pair> springs, particles;
};

}  // namespace

static std::vector<std::int32_t> neighbours(const CutPatch& patch, std::int32_t i) {
  std::vector<std::int32_t> node;
  for (const std::int32_t e : patch.star(i))
    for (const std::int32_t j : patch.corner[e])
      if (j != i) node.push_back(j);
  sort_unique(node);
  return node;
}

static double mean_edge(const CutPatch& patch, std::int32_t i) {
  double sum = 0;
  const std::vector<std::int32_t> around = neighbours(patch, i);
  for (const std::int32_t j : around) sum += (patch.X[j] - patch.X[i]).norm();
  return sum / static_cast<double>(around.size());
}

// Nodes up to two edges away.
static std::vector<std::int32_t> second_neighbours(const CutPatch& patch, std::int32_t i) {
  std::vector<std::int32_t> node;
  for (const std::int32_t j : neighbours(patch, i)) {
    const std::vector<std::int32_t> next = neighbours(patch, j);
    node.push_back(j);
    node.insert(node.end(), next.begin(), next.end());
  }
  sort_unique(node);
  std::erase(node, i);
  return node;
}

static void add_pairs(const CutPatch& patch, std::int32_t i, System& system) {
  for (const std::int32_t j : neighbours(patch, i))
    system.springs.push_back({i, j, (patch.X[j] - patch.X[i]).norm()});
  const double mean = mean_edge(patch, i);
  for (const std::int32_t j : second_neighbours(patch, i)) {
    const double r0 = 0.5 * (mean + mean_edge(patch, j));
    system.particles.push_back({i, j, r0 * r0});
  }
}

static System make_system(const CutSurroundings& around, const std::vector<NodeRole>& role,
                          double least_step, std::vector<Vec3>& X) {
  System system{around, role, least_step, X, {}, {}, {}};
  for (std::int32_t i = 0; i < around.patch.n_nodes(); ++i) {
    if (role[i] == NodeRole::stays || around.boundary[i].freedom == NodeFreedom::fixed) continue;
    system.movable.push_back(i);
    add_pairs(around.patch, i, system);
  }
  return system;
}

// Puts node i to `to`, or as far as the elements around allow. Returns how far it went.
static double go(System& system, std::int32_t i, const Vec3& to) {
  const Vec3 from = system.X[i];
  const double least = std::min(system.least_step, star_step(system.around.patch, system.X, i));
  for (const double part : {1.0, 0.5, 0.25}) {
    system.X[i] = project_to_boundary(system.around.boundary[i], from + part * (to - from));
    if (star_step(system.around.patch, system.X, i) >= least) return (system.X[i] - from).norm();
  }
  system.X[i] = from;
  return 0;
}

static void displace(System& system) {
  for (const std::int32_t i : system.movable)
    if (system.role[i] == NodeRole::on_surface)
      go(system, i, foot_on_surface(system.around, i, system.X[i]));
}

static std::vector<Vec3> forces(const System& system) {
  std::vector<Vec3> force(system.X.size(), Vec3::Zero());
  for (const Pair& pair : system.springs) {
    const Vec3 d = system.X[pair.other] - system.X[pair.i];
    const double r = d.norm();
    if (r > 0) force[pair.i] += spring(spring_scale, r, pair.length) * d;
  }
  for (const Pair& pair : system.particles) {
    const Vec3 d = system.X[pair.i] - system.X[pair.other];
    if (const double r2 = d.squaredNorm(); r2 > 0) force[pair.i] += repel(r2, pair.length) * d;
  }
  return force;
}

// Nodes on the surface slide along it.
static Vec3 target(const System& system, std::int32_t i, const Vec3& force) {
  const CutSurroundings& around = system.around;
  Vec3 step = gain * force;
  const std::span<const SurfacePoint> points = around.points.of(i);
  if (system.role[i] == NodeRole::on_surface && !points.empty()) {
    const Vec3 N = fit_surface(points, system.X[i], around.h).N;
    step -= N * N.dot(step);
  }
  const double most = longest_step * around.h, length = step.norm();
  if (length > most) step *= most / length;
  return system.X[i] + step;
}

// Returns the largest motion.
static double take_step(System& system) {
  const std::vector<Vec3> force = forces(system);
  double largest = 0;
  for (const std::int32_t i : system.movable)
    largest = std::max(largest, go(system, i, target(system, i, force[i])));
  return largest;
}

void homogenise_nodes(const CutSurroundings& around, const std::vector<NodeRole>& role,
                      double least_step, std::vector<Vec3>& X) {
  System system = make_system(around, role, least_step, X);
  for (int step = 0; step < most_steps; ++step) {
    if (step % steps_a_round == 0) displace(system);
    if (take_step(system) < at_rest * around.h) break;
  }
  displace(system);
}

}  // namespace trocar
