#include "collision/hull_manifold.h"

#include <algorithm>
#include <optional>

namespace trocar {

namespace {

constexpr double as_deep = 2;         // as the nearest points
constexpr double depth_slack = 1e-3;  // of the triangle's size
constexpr std::size_t solid = 4;      // faces

// Of the triangle's point straight above or below p, nothing where p is beside it.
std::optional<std::array<double, 3>> weights_along(const Vec3& p, const Triangle& x,
                                                   const Vec3& n) {
  const double twice_area = area_normal(x).dot(n);
  std::array<double, 3> weight;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3 &q = x[(a + 1) % 3], &r = x[(a + 2) % 3];
    weight[a] = (r - q).cross(p - q).dot(n) / twice_area;
    if (!(weight[a] > 0)) return std::nullopt;
  }
  return weight;
}

// The face that the triangle lies on, or would if it came along its normal.
std::size_t facing_face(const HullFaces& faces, const Vec3& n) {
  std::size_t facing = 0;
  for (std::size_t k = 1; k < faces.normal.size(); ++k)
    if (n.dot(faces.normal[k]) < n.dot(faces.normal[facing])) facing = k;
  return facing;
}

// What of a segment lies over a face, between the planes of all others.
std::optional<SegmentPart> part_over_face(const Segment& segment, const HullFaces& faces,
                                          std::size_t face) {
  SegmentPart part;
  for (std::size_t k = 0; k < faces.normal.size(); ++k) {
    const Vec3& n = faces.normal[k];
    if (k != face && !clip_segment(segment, faces.offset[k] * n, -n, part)) return std::nullopt;
  }
  return part;
}

struct Limits {
  double deepest = 0, margin = 0;
  bool allow(double gap) const { return gap >= deepest && gap < margin; }
};

void add_corners(const PieceCore& core, const Triangle& x, const Vec3& n, const Limits& limits,
                 Manifold& manifold) {
  std::array<double, Manifold::most_corners> gaps{};
  for (const Vec3& p : core.points) {
    const double gap = n.dot(p - x[0]) - core.radius;
    const bool is_full = manifold.n_points == Manifold::most_corners;
    if (!limits.allow(gap) || (is_full && gap >= gaps.back())) continue;
    const auto weight = weights_along(p, x, n);
    if (!weight) continue;
    if (!is_full) ++manifold.n_points;
    std::size_t k = manifold.n_points - 1;
    for (; k > 0 && gaps[k - 1] > gap; --k) {
      gaps[k] = gaps[k - 1];
      manifold.of[k] = manifold.of[k - 1];
    }
    gaps[k] = gap;
    manifold.of[k] = {.weight = *weight, .point = p - core.radius * n, .normal = -n};
  }
}

void add_edges(const PieceCore& core, const Triangle& x, const Vec3& n, const Limits& limits,
               Manifold& manifold) {
  const std::size_t face = facing_face(core.faces, n);
  const Vec3& out = core.faces.normal[face];
  for (std::size_t a = 0; a < 3; ++a) {
    const Segment edge = {x[a], x[(a + 1) % 3]};
    const std::optional<SegmentPart> part = part_over_face(edge, core.faces, face);
    if (!part) continue;
    for (const double t : {part->t0, part->t1}) {
      const Vec3 q = point_at(edge, t);
      const double gap = out.dot(q) - core.faces.offset[face] - core.radius;
      if (t == 0 || t == 1 || !limits.allow(gap)) continue;
      ManifoldPoint& point = manifold.of[manifold.n_points++];
      point = {.point = q - gap * out, .normal = out};
      point.weight[a] = 1 - t;
      point.weight[(a + 1) % 3] = t;
    }
  }
}

}  // namespace

Manifold find_manifold(const PieceCore& core, const Triangle& triangle, double nearest_gap,
                       double margin) {
  Manifold manifold;
  const std::optional<Vec3> n = unit_normal(triangle);
  if (core.faces.normal.size() < solid || !n) return manifold;
  const double size = (triangle[1] - triangle[0]).norm();
  const Limits limits{.deepest = as_deep * std::min(0.0, nearest_gap) - depth_slack * size,
                      .margin = margin};
  add_corners(core, triangle, *n, limits, manifold);
  add_edges(core, triangle, *n, limits, manifold);
  return manifold;
}

}  // namespace trocar
