#include "collision_random.h"

namespace trocar {

Vec3 Random::in_box(double half) {
  const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
  return {x, y, z};
}

Vec3 Random::direction() {
  for (;;) {
    const Vec3 d = in_box(1);
    if (d.norm() > 0.1 && d.norm() < 1) return d.normalized();
  }
}

Quat Random::rotation() {
  const Vec3 axis = direction();
  return Quat(Eigen::AngleAxisd(between(0, 3.14), axis));
}

Triangle Random::triangle(double half) {
  const Vec3 a = in_box(half), b = in_box(half), c = in_box(half);
  return {a, b, c};
}

Quat rotation_from_z(const Vec3& direction) {
  return Quat::FromTwoVectors(Vec3::UnitZ(), direction);
}

Vec3 at_weights(const Triangle& x, const std::array<double, 3>& w) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
}

}  // namespace trocar
