#include "cutting/cut_plane_reaches.h"

namespace trocar {

namespace {

constexpr double sharpest = 0.5;  // cosine of the bend at which a new reach begins

// Whether the segments a b and c d cross.
bool do_cross(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto parts = [](const Vec3& from, const Vec3& to, const Vec3& p, const Vec3& q) {
    return (cross_z(to - from, p - from) > 0) != (cross_z(to - from, q - from) > 0);
  };
  return parts(a, b, c, d) && parts(c, d, a, b);
}

bool begins_reach(const std::vector<Vec3>& reach, const Vec3& next) {
  if (reach.size() < 2) return false;
  const Vec3 before = reach.back() - reach[reach.size() - 2], way = next - reach.back();
  if (before.dot(way) <= sharpest * before.norm() * way.norm()) return true;
  for (std::size_t k = 0; k + 2 < reach.size(); ++k)
    if (do_cross(reach[k], reach[k + 1], reach.back(), next)) return true;
  return false;
}

}  // namespace

std::vector<std::vector<Vec3>> reaches(std::span<const Vec3> path) {
  std::vector<std::vector<Vec3>> result{{path.front()}};
  for (std::size_t k = 1; k < path.size(); ++k) {
    if (begins_reach(result.back(), path[k])) result.push_back({path[k - 1]});
    result.back().push_back(path[k]);
  }
  return result;
}

}  // namespace trocar
