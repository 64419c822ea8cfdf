#include "engine/apply_cut_momentum.h"

#include <algorithm>
#include <cmath>

namespace trocar {

Motion motion_of(std::span<const std::int32_t> nodes, std::span<const double> mass,
                 const GlobalState& state, const Vec3& about) {
  Motion motion;
  for (const std::int32_t node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    const Vec3 v(state.v[3 * i], state.v[3 * i + 1], state.v[3 * i + 2]);
    const Vec3 r = state.x[i] - about;
    motion.mass += mass[i];
    motion.centre += mass[i] * state.x[i];
    motion.momentum += mass[i] * v;
    motion.angular += mass[i] * r.cross(v);
    motion.scale += mass[i] * std::sqrt(v.dot(v));
    motion.kinetic += 0.5 * mass[i] * v.dot(v);
    motion.inertia += mass[i] * (r.dot(r) * Mat3::Identity() - r * r.transpose());
  }
  if (motion.mass > 0) motion.centre /= motion.mass;
  return motion;
}

Motion motion_about_centre(std::span<const std::int32_t> nodes, std::span<const double> mass,
                           const GlobalState& state) {
  return motion_of(nodes, mass, state, motion_of(nodes, mass, state, Vec3::Zero()).centre);
}

static Mat3 cross_matrix(const Vec3& r) {
  Mat3 cross;
  cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return cross;
}

// 1 for each component in which a step moves the node.
static Vec3 freedom_of(const EditedNodes& nodes, std::int32_t node) {
  const bool is_held = find_hold(nodes.holds, node) != nullptr;
  const unsigned fixed = is_held ? all_components : nodes.fixed[node];
  Vec3 freedom;
  for (int j = 0; j < 3; ++j) freedom[j] = (fixed >> j & 1) == 0 ? 1 : 0;
  return freedom;
}

// Gives the nodes the rigid increment a + w x (x - centre), as far as each is free to move, that
// makes momentum and angular momentum what they were.
static void restore_momentum(const EditedNodes& nodes, const Motion& before, GlobalState& state,
                             CutRecord& record) {
  const Vec3& about = before.centre;
  Motion after = motion_of(nodes.node, nodes.mass, state, about);
  const double kinetic_before = before.kinetic;
  // Of dv = D (a - r x w) with D the freedom of a node: sum m dv = dP and sum m r x dv = dL.
  // Lengths over that of the patch, so that both weigh alike.
  const double spread = std::sqrt(after.inertia.trace() / after.mass);
  const double length = spread > 0 ? spread : 1;
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  for (const std::int32_t i : nodes.node) {
    const Mat3 D = freedom_of(nodes, i).asDiagonal(),
               R = cross_matrix((state.x[i] - about) / length);
    A.topLeftCorner<3, 3>() += nodes.mass[i] * D;
    A.topRightCorner<3, 3>() -= nodes.mass[i] * D * R;
    A.bottomLeftCorner<3, 3>() += nodes.mass[i] * R * D;
    A.bottomRightCorner<3, 3>() -= nodes.mass[i] * R * D * R;
  }
  Eigen::Matrix<double, 6, 1> b;
  b << before.momentum - after.momentum, (before.angular - after.angular) / length;
  const Eigen::Matrix<double, 6, 1> increment = A.completeOrthogonalDecomposition().solve(b);
  const Vec3 a = increment.head<3>(), w = increment.tail<3>() / length;
  if (!increment.allFinite()) return;
  for (const std::int32_t i : nodes.node)
    Vec3::Map(&state.v[3 * static_cast<std::size_t>(i)]) +=
        freedom_of(nodes, i).cwiseProduct(a + w.cross(state.x[i] - about));
  after = motion_of(nodes.node, nodes.mass, state, about);
  const double scale = std::max(before.scale, 1e-300);
  record.momentum_change =
      std::max(record.momentum_change, (after.momentum - before.momentum).norm() / scale);
  record.kinetic_energy_change += after.kinetic - kinetic_before;
}

void add_kinetic_energy(std::span<const std::int32_t> nodes, std::span<const double> mass,
                        double energy, GlobalState& state, CutRecord& record) {
  constexpr double most = 1.5;
  const Motion motion = motion_about_centre(nodes, mass, state);
  const Vec3& about = motion.centre;
  // Nodes on a line have no inertia around it, nor angular momentum.
  const Vec3 w = motion.inertia.completeOrthogonalDecomposition().solve(motion.angular);
  const double rigid = 0.5 * (motion.momentum.squaredNorm() / motion.mass + motion.angular.dot(w));
  const double square = 1 + energy / (motion.kinetic - rigid);
  if (!std::isfinite(square)) return;
  const double factor = std::clamp(std::sqrt(std::max(square, 0.0)), 1 / most, most);
  for (const std::int32_t node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    const Vec3 of_rigid = motion.momentum / motion.mass + w.cross(state.x[i] - about);
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = of_rigid[static_cast<Eigen::Index>(k)];
      state.v[3 * i + k] = v + factor * (state.v[3 * i + k] - v);
    }
  }
  record.kinetic_energy_change += motion_of(nodes, mass, state, about).kinetic - motion.kinetic;
}

void restore_motion(const EditedNodes& nodes, const Motion& before, GlobalState& state,
                    CutRecord& record) {
  restore_momentum(nodes, before, state, record);
  const double kinetic = motion_of(nodes.node, nodes.mass, state, before.centre).kinetic;
  add_kinetic_energy(nodes.adjustable, nodes.mass, before.kinetic - kinetic, state, record);
}

}  // namespace trocar
