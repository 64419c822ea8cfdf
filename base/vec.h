// The small vectors and the rigid motion that everything outside the kernels is written with.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace trocar {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

// In the order of the coordinates.
inline bool is_before(const Vec3& a, const Vec3& b) {
  if (a.x() != b.x()) return a.x() < b.x();
  if (a.y() != b.y()) return a.y() < b.y();
  return a.z() < b.z();
}

// Of the cross product, the component along z.
inline double cross_z(const Vec3& a, const Vec3& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// A rigid motion: x = rotation * x_local + translation. [m]
struct Pose {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 apply(const Vec3& x_local) const { return rotation * x_local + translation; }
  Vec3 apply_inverse(const Vec3& x) const { return rotation.conjugate() * (x - translation); }
};

}  // namespace trocar
