#include "mesh/barycentric.h"

namespace trocar {

std::array<double, 4> barycentric(std::span<const std::int32_t> corner, std::span<const Vec3> x,
                                  const Vec3& p) {
  const auto at = [&](std::size_t a) { return x[corner[a]]; };
  Mat3 edges = Mat3::Identity();
  for (std::size_t a = 1; a < corner.size(); ++a)
    edges.col(static_cast<Eigen::Index>(a) - 1) = at(a) - at(0);
  const Vec3 w = edges.inverse() * (p - at(0));
  std::array<double, 4> weight{1 - w[0] - w[1], w[0], w[1], 0};
  if (corner.size() == 4) {
    weight[0] -= w[2];
    weight[3] = w[2];
  }
  return weight;
}

Vec3 interpolate(std::span<const std::int32_t> corner, std::span<const double> weight,
                 std::span<const Vec3> field) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < corner.size(); ++a) sum += weight[a] * field[corner[a]];
  return sum;
}

}  // namespace trocar
