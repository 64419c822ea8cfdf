// Weighted mean of the planes that the crossing points carry.
#include "cutting/cut_surface_fit.h"

#include <algorithm>

#include "base/check.h"

namespace trocar {

SurfacePoints surface_points(const CutPatch& patch, const CutStroke& stroke) {
  const std::vector<std::span<const CutHit>> hits = hits_of(stroke, patch.element);
  SurfacePoints points{{0}, {}};
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(points.point.size());
    for (const std::int32_t e : patch.star(i))
      for (const CutHit& hit : hits[e]) {
        // An edge is hit once and listed by all its elements.
        const auto same = [&](const SurfacePoint& p) { return p.X == hit.X; };
        if (std::none_of(points.point.begin() + first, points.point.end(), same))
          points.point.push_back({hit.X, hit.N});
      }
    points.offset.push_back(static_cast<std::int32_t>(points.point.size()));
  }
  return points;
}

SurfacePlane fit_surface(std::span<const SurfacePoint> points, const Vec3& X, double h) {
  CHECK(!points.empty());
  Vec3 N = Vec3::Zero();
  double sum = 0, distance = 0;
  for (const SurfacePoint& p : points) {
    const double r2 = (X - p.X).squaredNorm() / (h * h);
    const double w = 1 / ((1 + 4 * r2) * (1 + 4 * r2));
    N += w * p.N;
    distance += w * p.N.dot(X - p.X);
    sum += w;
  }
  const double size = N.norm();
  // Normals that cancel: two sheets of one stroke meet here; one is as good as the other.
  if (!(size > 0.1 * sum)) return {points.front().N, points.front().N.dot(points.front().X)};
  SurfacePlane plane{N / size, 0};
  plane.offset = plane.N.dot(X) - distance / sum;
  return plane;
}

}  // namespace trocar
