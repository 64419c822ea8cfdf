#include "engine/plane_tip.h"

#include <algorithm>
#include <cmath>

namespace trocar {

Vec3 tip_in_plane(std::span<const Vec3> edge, double thickness) {
  const Vec3 &tip = edge.front(), &top = edge.back();
  Vec3 place = std::abs(tip.z()) <= std::abs(top.z()) ? tip : top;
  if (tip.z() * top.z() < 0) place = tip + tip.z() / (tip.z() - top.z()) * (top - tip);
  if (std::abs(place.z()) <= 0.5 * thickness) place.z() = 0;
  return place;
}

Vec3 first_tip(const BladeSweep& sweep) {
  if (sweep.tissue_way.empty()) return sweep.before.front();
  return sweep.before.front() + sweep.tissue_way.front();
}

std::vector<Vec3> way_of_tip(const BladeSweep& sweep, double spacing) {
  constexpr double most = 1000;
  const Vec3 way = sweep.after.front() - first_tip(sweep);
  const int n = static_cast<int>(std::ceil(std::clamp(way.norm() / spacing, 1.0, most)));
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k) points.push_back(sweep.after.front() - way * (1.0 * k / n));
  return points;
}

}  // namespace trocar
