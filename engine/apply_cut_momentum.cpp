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

// Gives the nodes the rigid increment a + w x (x - centre) that makes momentum and angular momentum
// what they were.
static void restore_momentum(std::span<const std::int32_t> nodes, std::span<const double> mass,
                             const Motion& before, GlobalState& state, CutRecord& record) {
  const Vec3 about = before.centre;
  Motion after = motion_of(nodes, mass, state, about);
  const double kinetic_before = before.kinetic;
  // Two unknown vectors: m a + w x m d = dP and m d x a + I w = dL with d = centre after - about.
  const Vec3 d = after.centre - about;
  Mat3 cross;
  cross << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  Eigen::Matrix<double, 6, 6> A;
  A.block<3, 3>(0, 0) = after.mass * Mat3::Identity();
  A.block<3, 3>(0, 3) = -after.mass * cross;
  A.block<3, 3>(3, 0) = after.mass * cross;
  A.block<3, 3>(3, 3) = after.inertia;
  Eigen::Matrix<double, 6, 1> b;
  b << before.momentum - after.momentum, before.angular - after.angular;
  const Eigen::Matrix<double, 6, 1> increment = A.partialPivLu().solve(b);
  const Vec3 a = increment.head<3>(), w = increment.tail<3>();
  if (!increment.allFinite()) return;
  for (const std::int32_t node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    const Vec3 dv = a + w.cross(state.x[i] - about);
    for (std::size_t k = 0; k < 3; ++k) state.v[3 * i + k] += dv[static_cast<Eigen::Index>(k)];
  }
  after = motion_of(nodes, mass, state, about);
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

void restore_motion(std::span<const std::int32_t> nodes, std::span<const std::int32_t> adjustable,
                    std::span<const double> mass, const Motion& before, GlobalState& state,
                    CutRecord& record) {
  restore_momentum(nodes, mass, before, state, record);
  const double kinetic = motion_of(nodes, mass, state, before.centre).kinetic;
  add_kinetic_energy(adjustable, mass, before.kinetic - kinetic, state, record);
}

}  // namespace trocar
