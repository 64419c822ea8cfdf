#include "collision/plane_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/grouped.h"
#include "base/segment.h"

namespace trocar {

namespace {

constexpr double at_end = 1e-6;  // of an edge, over its length

Vec3 in_plane(const Vec3& p) {
  return {p.x(), p.y(), 0};
}

// Outward unit normal of an edge with the inside to its left; zero for an edge without length.
Vec3 edge_normal(const Segment& edge) {
  const Vec3 d = edge[1] - edge[0];
  return Vec3(d.y(), -d.x(), 0).stableNormalized();
}

// Convex hull in the plane, counter-clockwise (Andrew's monotone chain).
std::vector<Vec3> convex_polygon(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end(), is_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec3> polygon;
  const auto half = [&](auto first, auto last) {
    const std::size_t start = polygon.size();
    for (auto p = first; p != last; ++p) {
      while (polygon.size() >= start + 2 &&
             cross_z(polygon.back() - polygon[polygon.size() - 2], *p - polygon.back()) <= 0)
        polygon.pop_back();
      polygon.push_back(*p);
    }
    polygon.pop_back();
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return polygon;
}

// Every pair of points on both sides of the plane gives a point of the section; those of pairs
// that are no edge of the hull lie inside it.
std::vector<Vec3> hull_section(const std::vector<Vec3>& points) {
  std::vector<Vec3> section;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].z() == 0) section.push_back(points[i]);
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const double zi = points[i].z(), zj = points[j].z();
      if (zi * zj < 0)
        section.push_back(in_plane(point_at({points[i], points[j]}, zi / (zi - zj))));
    }
  }
  return convex_polygon(std::move(section));
}

std::size_t n_sides(const PlaneSection& section) {
  return section.points.size() < 3 ? 1 : section.points.size();
}

Segment side(const PlaneSection& section, std::size_t k) {
  return {section.points[k], section.points[(k + 1) % section.points.size()]};
}

bool contains(const PlaneSection& section, const Vec3& p) {
  if (section.points.size() < 3) return false;
  for (std::size_t k = 0; k < n_sides(section); ++k) {
    const Segment s = side(section, k);
    if (cross_z(s[1] - s[0], p - s[0]) < 0) return false;
  }
  return true;
}

// Radius of the circle that the sphere round a core point leaves in the plane, negative for none.
double circle_radius(const PlaneSection& section, const Vec3& core) {
  const double r2 = section.radius * section.radius - core.z() * core.z();
  return r2 < 0 ? -1 : std::sqrt(r2);
}

SegmentPair closest(const PlaneSection& section, const Segment& edge) {
  SegmentPair best = closest_points_segments(side(section, 0), edge);
  for (std::size_t k = 1; k < n_sides(section); ++k) {
    const SegmentPair pair = closest_points_segments(side(section, k), edge);
    if (pair.distance2 < best.distance2) best = pair;
  }
  return best;
}

// A core point behind an edge. is_across: it lies in the middle of a side of a polygon, where that
// leaves the edge's strip, and the side does not face the edge.
struct Behind {
  Vec3 core;
  bool is_across = false;
};

// Whether a side of a polygon with this normal does not face an edge of normal n.
bool lies_across(const PlaneSection& section, const Vec3& normal, const Vec3& n) {
  constexpr double facing = 0.5;  // cosine
  return section.points.size() > 2 && -n.dot(normal) < facing;
}

// The core point straight behind the edge whose circle reaches deepest: an end of the part that
// lies in the edge's strip and reaches the plane, or where the core passes through the plane.
std::optional<Behind> deepest_behind(const PlaneSection& section, const Segment& edge,
                                     const Vec3& n) {
  const Vec3 along = edge[1] - edge[0];
  std::optional<Behind> deepest;
  double lowest = 0;
  const auto offer = [&](const Segment& s, double t) {
    const Vec3 p = point_at(s, t);
    const double radius = std::max(0.0, circle_radius(section, p));
    const double height = n.dot(p - edge[0]);
    if (height > 0 || (deepest && height - radius >= lowest)) return;
    deepest =
        Behind{.core = p, .is_across = t > 0 && t < 1 && lies_across(section, edge_normal(s), n)};
    lowest = height - radius;
  };
  for (std::size_t k = 0; k < n_sides(section); ++k) {
    const Segment s = side(section, k);
    SegmentPart part;
    const Vec3 top(0, 0, section.radius), down(0, 0, -1);
    if (!clip_segment(s, edge[0], along, part) || !clip_segment(s, edge[1], -along, part) ||
        !clip_segment(s, top, down, part) || !clip_segment(s, -top, -down, part))
      continue;
    const double z0 = s[0].z(), z1 = s[1].z();
    const double through = z0 == z1 ? part.t0 : std::clamp(z0 / (z0 - z1), part.t0, part.t1);
    for (const double t : {through, part.t0, part.t1}) offer(s, t);
  }
  return deepest;
}

TrianglePoint on_edge(const Segment& edge, double t) {
  return {.point = point_at(edge, t), .weight = {1 - t, t, 0}};
}

TrianglePoint straight_above(const Vec3& core, const Segment& edge) {
  return on_edge(edge, share_to(edge[0], Vec3(edge[1] - edge[0]), core));
}

}  // namespace

PlaneEdges boundary_edges(const Surface& surface) {
  std::int32_t n_nodes = 0;
  for (const std::array<std::int32_t, 3>& triangle : surface.triangle)
    n_nodes = std::max(n_nodes, *std::max_element(triangle.begin(), triangle.end()) + 1);
  // Ends of the sides that start from each node.
  const Grouped<> ends = group_items(static_cast<std::size_t>(n_nodes), [&](const auto& put) {
    for (const std::array<std::int32_t, 3>& triangle : surface.triangle)
      for (std::size_t k = 0; k < 3; ++k) put(triangle[k], triangle[(k + 1) % 3]);
  });
  const auto has_side = [&](std::int32_t a, std::int32_t b) {
    return std::ranges::count(ends.of(a), b) > 0;
  };
  PlaneEdges edges;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = surface.triangle[t][k], b = surface.triangle[t][(k + 1) % 3];
      if (has_side(b, a)) continue;
      edges.node.push_back({a, b});
      edges.triangle.push_back(static_cast<std::int32_t>(t));
    }
  return edges;
}

PlaneSection plane_section(const PieceCore& core, const Pose& pose) {
  PlaneSection section{.radius = core.radius, .thickness = core.thickness};
  for (const Vec3& p : core.points) section.points.push_back(pose.apply(p));
  if (core.points.size() > 2) section.points = hull_section(section.points);
  return section;
}

std::optional<Touch> touch_edge(const PlaneSection& section, const Segment& edge, double margin) {
  const Vec3 n = edge_normal(edge);
  if (section.points.empty() || n.isZero(0)) return std::nullopt;
  const double length = (edge[1] - edge[0]).norm();
  const SegmentPair pair = closest(section, edge);
  const double distance = (in_plane(pair.first) - pair.second).norm();
  const bool is_crossing = distance <= 1e-9 * length || contains(section, edge[0]);
  std::optional<Behind> deepest;
  if (is_crossing || n.dot(pair.second - pair.first) > 0)
    deepest = deepest_behind(section, edge, n);
  // The edge only ends at that side, as one of tissue beside a plate does: the edges that the plate
  // lies on have the contact.
  if (deepest && deepest->is_across) return std::nullopt;
  if (is_crossing && !deepest && std::min(pair.t, 1 - pair.t) < at_end &&
      lies_across(section, signed_distance(section, pair.second).normal, n))
    return std::nullopt;
  const Vec3 core = deepest ? deepest->core : is_crossing ? pair.second : pair.first;
  const double radius = circle_radius(section, core);
  if (radius < 0 || (radius == 0 && section.radius > 0)) return std::nullopt;
  Touch touch = deepest ? touch_below(in_plane(core), straight_above(core, edge), n, radius)
                        : touch_of_points(in_plane(core), on_edge(edge, pair.t), n, radius);
  const double limit = 2 * section.radius + section.thickness + margin;
  if (touch.gap >= margin || is_lost(touch, limit)) return std::nullopt;
  if (touch.depth <= 1e-6 * length) touch.depth = 0;  // rounding decides what is inside
  return touch;
}

SignedDistance signed_distance(const PlaneSection& section, const Vec3& x) {
  if (section.points.empty()) return {.gap = std::numeric_limits<double>::infinity()};
  if (section.points.size() < 3) {
    const auto [a, b] = side(section, 0);
    const Vec3 core = nearest_on_segment(a, b, x);
    const Vec3 out = x - in_plane(core);
    const double radius = circle_radius(section, core);
    if (radius < 0) return {.gap = std::numeric_limits<double>::infinity()};
    return {.normal = out.stableNormalized(), .gap = out.norm() - radius};
  }
  SignedDistance farthest{.gap = -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < n_sides(section); ++k) {
    const Segment s = side(section, k);
    const Vec3 normal = edge_normal(s);
    const double gap = normal.dot(x - s[0]) - section.radius;
    if (gap > farthest.gap) farthest = {.normal = normal, .gap = gap};
  }
  return farthest;
}

Vec3 plane_way_out(const PlaneEdges& edges, std::span<const Vec3> x, const Vec3& p) {
  int winding = 0;
  double best2 = -1;
  Vec3 way_out = Vec3::Zero();
  for (const std::array<std::int32_t, 2>& node : edges.node) {
    const Segment edge = {x[node[0]], x[node[1]]};
    // A ray towards +x leaves through edges that run upwards.
    const bool is_up = edge[0].y() <= p.y() && p.y() < edge[1].y();
    const bool is_down = edge[1].y() <= p.y() && p.y() < edge[0].y();
    const double turn = cross_z(edge[1] - edge[0], p - edge[0]);
    if (is_up && turn > 0) ++winding;
    if (is_down && turn < 0) --winding;
    const Vec3 to_edge = nearest_on_segment(edge[0], edge[1], p) - p;
    const Vec3 n = edge_normal(edge);
    if (to_edge.dot(n) <= 0 || (best2 >= 0 && to_edge.squaredNorm() >= best2)) continue;
    best2 = to_edge.squaredNorm();
    way_out = n;
  }
  return winding > 0 ? way_out : Vec3::Zero();
}

}  // namespace trocar
