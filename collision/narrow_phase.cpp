#include "collision/narrow_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/segment.h"

namespace trocar {

namespace {

constexpr double epa_agreement = 0.5;    // cos 60 degrees
constexpr double coincidence = 1e-9;     // edges: closest points nearer than this have no direction
constexpr double cast_tolerance = 1e-6;  // of a depth, in edges
constexpr int max_cast_steps = 64;
constexpr double at_border = 1e-6;                                // weight of a corner
constexpr std::array<double, 4> nudges = {0, 3e-6, -3e-6, 1e-5};  // in edges

struct CorePair {
  Vec3 core = Vec3::Zero();
  TrianglePoint tissue;
  bool is_apart = true;
  std::optional<HullPair> penetration;  // EPA's answer where a hull intersects
};

struct Facet {
  Triangle x;
  Vec3 n;
  double edge = 0;  // the longest
};

double longest_edge(const Triangle& x) {
  return std::sqrt(std::max(
      {(x[1] - x[0]).squaredNorm(), (x[2] - x[1]).squaredNorm(), (x[0] - x[2]).squaredNorm()}));
}

// Where Bullet fails it succeeds for the triangle a few hundredths of a micrometre beside.
std::optional<HullPair> closest_to_hull(const HullShape& hull, const Facet& facet) {
  for (const double nudge : nudges) {
    Triangle x = facet.x;
    for (Vec3& corner : x) corner += nudge * facet.edge * facet.n;
    std::optional<HullPair> pair = hull.closest(x);
    if (!pair) continue;
    pair->on_triangle = with_weights(facet.x, pair->on_triangle.weight);
    return pair;
  }
  return std::nullopt;
}

CorePair closest_of_hull(const HullShape& hull, const Facet& facet) {
  const std::optional<HullPair> pair = closest_to_hull(hull, facet);
  if (!pair) return {.is_apart = false};
  return {.core = pair->on_hull,
          .tissue = pair->on_triangle,
          .is_apart = pair->distance > coincidence * facet.edge,
          .penetration = pair};
}

CorePair closest(const PieceCore& core, const Facet& facet) {
  if (core.hull) return closest_of_hull(*core.hull, facet);
  CorePair pair;
  if (core.points.size() == 1) {
    pair.core = core.points[0];
    pair.tissue = closest_point_triangle(pair.core, facet.x);
  } else {
    const SegmentTrianglePair p =
        closest_points_segment_triangle({core.points[0], core.points[1]}, facet.x);
    pair.core = p.on_segment;
    pair.tissue = p.on_triangle;
  }
  pair.is_apart = (pair.core - pair.tissue.point).norm() > coincidence * facet.edge;
  return pair;
}

// A point of the core and the point of the triangle straight above it.
struct Below {
  Vec3 core;
  TrianglePoint tissue;
};

std::optional<Below> deepest_of_segment(const Segment& segment, const Facet& facet) {
  const std::optional<SegmentPart> part = part_over_triangle(segment, facet.x, facet.n);
  if (!part) return std::nullopt;
  const Vec3 p0 = point_at(segment, part->t0), p1 = point_at(segment, part->t1);
  const Vec3 deepest = facet.n.dot(p0 - p1) < 0 ? p0 : p1;
  if (facet.n.dot(deepest - facet.x[0]) > 0) return std::nullopt;
  return Below{.core = deepest, .tissue = closest_point_triangle(deepest, facet.x)};
}

bool is_at_border(const TrianglePoint& p) {
  return *std::min_element(p.weight.begin(), p.weight.end()) < at_border;
}

// Lowers the triangle along -n below the hull and lets it rise until it touches, by conservative
// advancement: it never passes the plane that separates the two. One that comes with its border
// against a side of the hull that lies across belongs to an edge of the tissue that lies on this
// side, as on a plate, and the other triangles there have the contact. (Blades touch with flanks.)
std::optional<Below> deepest_of_hull(const PieceCore& core, const Facet& facet) {
  const double tolerance = cast_tolerance * facet.edge;
  double lowest = 0;
  for (const Vec3& p : core.points) lowest = std::min(lowest, facet.n.dot(p - facet.x[0]));
  double shift = tolerance - lowest, closing = 1;
  for (int k = 0; k < max_cast_steps && shift >= 0; ++k) {
    Facet lowered = facet;
    for (Vec3& x : lowered.x) x -= shift * facet.n;
    const std::optional<HullPair> pair = closest_to_hull(*core.hull, lowered);
    if (!pair) return std::nullopt;
    if (pair->distance <= 2 * tolerance) {
      const bool is_across = closing < epa_agreement && core.least_flatness == 0;
      if (is_across && is_at_border(pair->on_triangle)) return std::nullopt;
      return Below{.core = pair->on_hull,
                   .tissue = with_weights(facet.x, pair->on_triangle.weight)};
    }
    closing = -facet.n.dot(pair->normal);
    if (closing <= coincidence) return std::nullopt;  // it passes beside the hull
    shift -= pair->distance / closing;
  }
  return std::nullopt;
}

std::optional<Below> deepest_below(const PieceCore& core, const Facet& facet) {
  if (core.hull) return deepest_of_hull(core, facet);
  if (core.points.size() == 2) return deepest_of_segment({core.points[0], core.points[1]}, facet);
  return std::nullopt;  // touch_of_points does it for a point
}

Touch touch_along(const HullPair& pair, double radius) {
  return {.core = pair.on_hull,
          .tissue = pair.on_triangle,
          .normal = pair.normal,
          .gap = pair.distance - radius};
}

// The core intersects the triangle or lies behind it.
std::optional<Touch> touch_from_behind(const PieceCore& core, const Facet& facet,
                                       const CorePair& pair) {
  const bool has_epa = !pair.is_apart && pair.penetration.has_value();
  const double agreement = has_epa ? -pair.penetration->normal.dot(facet.n) : -1;
  if (agreement >= epa_agreement) return touch_along(*pair.penetration, core.radius);
  if (const auto below = deepest_below(core, facet))
    return touch_below(below->core, below->tissue, facet.n, core.radius);
  if (pair.is_apart) return touch_of_points(pair.core, pair.tissue, facet.n, core.radius);
  if (!core.hull) return touch_below(pair.core, pair.tissue, facet.n, core.radius);
  if (agreement > 0) return touch_along(*pair.penetration, core.radius);
  return std::nullopt;
}

}  // namespace

PieceCore make_core(const ConvexPiece& piece) {
  PieceCore core{.points = reduce_hull(piece.points),
                 .radius = piece.radius,
                 .least_flatness = piece.least_flatness,
                 .deepest = piece.deepest,
                 .has_edge = piece.has_edge};
  core.box = bounding_box(core.points);
  if (core.points.size() < 3) return core;
  core.thickness = core.box.size().minCoeff();
  core.hull.emplace(core.points);
  core.faces = hull_faces(core.points);
  return core;
}

namespace {

// Without asking Bullet (2 us a pair): the piece's box is farther than `reach` from the triangle's,
// and the piece is in front of it (a hull: its centre), or so far beside that nothing lies straight
// below.
bool is_out_of_reach(const PieceCore& core, const Facet& facet, double reach) {
  const auto [low, high] = bounding_box(facet.x);
  const Vec3 apart = (low - core.box.high).cwiseMax(core.box.low - high);
  if (apart.cwiseMax(0.0).squaredNorm() <= reach * reach) return false;
  if (!core.hull)
    return std::all_of(core.points.begin(), core.points.end(),
                       [&](const Vec3& p) { return facet.n.dot(p - facet.x[0]) >= 0; });
  const Vec3 to_triangle = facet.x[0] - core.box.middle();
  const double height = facet.n.dot(to_triangle);
  const double beside = (to_triangle - height * facet.n).norm();
  return height <= 0 || beside > 0.5 * core.box.size().norm() + facet.edge + reach;
}

}  // namespace

SignedDistance signed_distance(const PieceCore& core, const Vec3& x) {
  if (core.hull) {
    SignedDistance farthest{.gap = -std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < core.faces.normal.size(); ++k) {
      const double height = core.faces.normal[k].dot(x) - core.faces.offset[k];
      if (height > farthest.gap) farthest = {.normal = core.faces.normal[k], .gap = height};
    }
    farthest.gap -= core.radius;
    return farthest;
  }
  const Vec3 out = x - nearest_on_segment(core.points.front(), core.points.back(), x);
  const double distance = out.norm();
  return {.normal = distance > 0 ? Vec3(out / distance) : Vec3::Zero(),
          .gap = distance - core.radius};
}

bool is_lost(const Touch& touch, double limit) {
  return touch.depth > 0 && (touch.tissue.point - touch.core).norm() > limit;
}

Touch touch_below(const Vec3& core, const TrianglePoint& tissue, const Vec3& n, double radius) {
  const double depth = std::max(0.0, n.dot(tissue.point - core));
  return {.core = core, .tissue = tissue, .normal = -n, .gap = -depth - radius, .depth = depth};
}

Touch touch_of_points(const Vec3& core, const TrianglePoint& tissue, const Vec3& n, double radius) {
  const Vec3 d = tissue.point - core;
  const double distance = d.norm(), height = d.dot(n);
  if (distance == 0) return touch_below(core, tissue, n, radius);
  if (height <= 0)
    return {.core = core, .tissue = tissue, .normal = d / distance, .gap = distance - radius};
  const double beside = (d - height * n).norm();
  const double deepening = beside < radius ? 1 + height / radius : 1;
  return {.core = core,
          .tissue = tissue,
          .normal = (d - 2 * height * n) / distance,
          .gap = (beside - radius) * deepening,
          .depth = height};
}

std::optional<Touch> touch(const PieceCore& core, const Triangle& triangle, double margin) {
  const std::optional<Vec3> n = unit_normal(triangle);
  if (!n) return std::nullopt;
  const Facet facet{.x = triangle, .n = *n, .edge = longest_edge(triangle)};
  if (is_out_of_reach(core, facet, core.radius + margin)) return std::nullopt;
  const CorePair pair = closest(core, facet);
  const Vec3 to_tissue = pair.tissue.point - pair.core;
  std::optional<Touch> result;
  if (pair.is_apart && to_tissue.dot(facet.n) <= 0) {
    result = touch_of_points(pair.core, pair.tissue, facet.n, core.radius);
  } else {
    result = touch_from_behind(core, facet, pair);
  }
  if (!result || result->gap >= margin || is_lost(*result, depth_limit(core, margin)))
    return std::nullopt;
  if (result->depth <= 1e-6 * facet.edge) result->depth = 0;  // rounding decides what is inside
  return result;
}

}  // namespace trocar
