#include "collision/hull_reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar {

namespace {

std::size_t support(const std::vector<Vec3>& points, const Vec3& direction) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (direction.dot(points[i]) > direction.dot(points[best])) best = i;
  return best;
}

// Marks the extreme points in all directions of the lattice [-n, n]^3, seen from the centroid.
std::vector<bool> extremes(const std::vector<Vec3>& points, int n) {
  std::vector<bool> is_extreme(points.size(), false);
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k)
        if (i != 0 || j != 0 || k != 0) is_extreme[support(points, Vec3(i, j, k))] = true;
  return is_extreme;
}

std::vector<Vec3> take(const std::vector<Vec3>& points, const std::vector<bool>& is_taken) {
  std::vector<Vec3> taken;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_taken[i]) taken.push_back(points[i]);
  return taken;
}

// Takes the point farthest from all taken ones until there are n.
void take_farthest(const std::vector<Vec3>& points, std::size_t n, std::vector<bool>& is_taken) {
  std::vector<double> distance2(points.size(), std::numeric_limits<double>::max());
  const auto approach = [&](const Vec3& p) {
    for (std::size_t i = 0; i < points.size(); ++i)
      distance2[i] = std::min(distance2[i], (points[i] - p).squaredNorm());
  };
  const std::vector<Vec3> taken = take(points, is_taken);
  for (const Vec3& p : taken) approach(p);
  for (std::size_t count = taken.size(); count < n; ++count) {
    const auto farthest = static_cast<std::size_t>(
        std::max_element(distance2.begin(), distance2.end()) - distance2.begin());
    is_taken[farthest] = true;
    approach(points[farthest]);
  }
}

}  // namespace

std::vector<Vec3> reduce_hull(const std::vector<Vec3>& points) {
  if (points.size() <= max_hull_points) return points;
  const std::vector<Vec3> candidates = take(points, extremes(points, 4));
  if (candidates.size() <= max_hull_points) return candidates;
  std::vector<bool> is_taken = extremes(candidates, 1);
  take_farthest(candidates, max_hull_points, is_taken);
  return take(candidates, is_taken);
}

namespace {

// Adds the plane if all points lie behind it and no face has its normal yet.
void offer_face(const std::vector<Vec3>& points, const Vec3& normal, double offset,
                double tolerance, HullFaces& faces) {
  for (const Vec3& p : points)
    if (normal.dot(p) > offset + tolerance) return;
  for (std::size_t k = 0; k < faces.normal.size(); ++k)
    if (faces.normal[k].dot(normal) > 1 - 1e-12 &&
        std::abs(faces.offset[k] - offset) <= 2 * tolerance)
      return;
  faces.normal.push_back(normal);
  faces.offset.push_back(offset);
}

}  // namespace

HullFaces hull_faces(const std::vector<Vec3>& points) {
  HullFaces faces;
  double size = 0;
  for (const Vec3& p : points) size = std::max(size, (p - points[0]).norm());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        const Vec3 across = (points[j] - points[i]).cross(points[k] - points[i]);
        const double area = across.norm();
        if (area <= 1e-9 * size * size) continue;
        for (const double side : {1.0, -1.0}) {
          const Vec3 normal = side / area * across;
          offer_face(points, normal, normal.dot(points[i]), 1e-9 * size, faces);
        }
      }
  return faces;
}

}  // namespace trocar
