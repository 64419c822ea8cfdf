#include "engine/locate.h"

#include <algorithm>

namespace trocar {

namespace {

// Barycentric weights of a tetrahedron or (in the plane z = 0) a triangle.
std::array<double, 4> barycentric(std::span<const std::int32_t> corner, std::span<const Vec3> x,
                                  const Vec3& p) {
  const auto at = [&](std::size_t a) { return x[static_cast<std::size_t>(corner[a])]; };
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

double least_weight(const std::array<double, 4>& weight, std::size_t n) {
  return *std::min_element(weight.begin(), weight.begin() + static_cast<std::ptrdiff_t>(n));
}

bool box_holds(std::span<const std::int32_t> corner, std::span<const Vec3> x, const Vec3& p) {
  Vec3 low = x[static_cast<std::size_t>(corner[0])], high = low;
  for (const std::int32_t node : corner.subspan(1)) {
    low = low.cwiseMin(x[static_cast<std::size_t>(node)]);
    high = high.cwiseMax(x[static_cast<std::size_t>(node)]);
  }
  return (p.array() >= low.array() - 1e-12).all() && (p.array() <= high.array() + 1e-12).all();
}

}  // namespace

Location locate_point(const Mesh& mesh, std::span<const Vec3> x, const Vec3& point) {
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto corner = mesh.corners(e);
    if (!box_holds(corner, x, point)) continue;
    const std::array<double, 4> weight = barycentric(corner, x, point);
    if (least_weight(weight, corner.size()) >= -1e-12) return {.element = e, .weight = weight};
  }
  return {};
}

Location locate_nearest(const Mesh& mesh, std::span<const Vec3> x, const Vec3& point) {
  Location nearest = locate_point(mesh, x, point);
  if (nearest.element >= 0) return nearest;
  double best = -1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto corner = mesh.corners(e);
    const std::array<double, 4> weight = barycentric(corner, x, point);
    const double least = least_weight(weight, corner.size());
    if (least > best) {
      best = least;
      nearest = {.element = e, .weight = weight};
    }
  }
  return nearest;
}

Vec3 interpolate(const Mesh& mesh, const Location& location, std::span<const Vec3> field) {
  Vec3 sum = Vec3::Zero();
  const auto corner = mesh.corners(location.element);
  for (std::size_t a = 0; a < corner.size(); ++a)
    sum += location.weight[a] * field[static_cast<std::size_t>(corner[a])];
  return sum;
}

}  // namespace trocar
