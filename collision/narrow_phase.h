// One convex piece of a tool against one triangle of tissue: where they touch, and in which
// direction tissue must go. Pure functions in the tool's frame.
#pragma once

#include <optional>

#include "base/box.h"
#include "collision/closest_point.h"
#include "collision/hull_bullet.h"
#include "collision/hull_reduce.h"
#include "collision/tool_shape.h"

namespace trocar {

// A piece is its core (a point, a segment, a hull) thickened by the radius.
struct PieceCore {
  std::vector<Vec3> points;       // a hull has at most 64
  double radius = 0;              // [m]
  std::optional<HullShape> hull;  // of three and more points
  HullFaces faces;                // of a hull
  Box box;                        // around the points [m]
  double thickness = 0;           // shortest side of a hull's box, zero for points and segments [m]
  double least_flatness = 0;      // see ConvexPiece
  double deepest = std::numeric_limits<double>::infinity();
  bool has_edge = false;
};
PieceCore make_core(const ConvexPiece& piece);

// Of a point in the tool's frame: from the thickened piece. Outside of a hull without thickness it
// is that of the farthest face plane, less than the distance; inside it is exact.
struct SignedDistance {
  Vec3 normal = Vec3::Zero();
  double gap = 0;
};
SignedDistance signed_distance(const PieceCore& core, const Vec3& x);

// How far behind a triangle the core may be (is_lost).
inline double depth_limit(const PieceCore& core, double margin) {
  return 2 * core.radius + core.thickness + margin;
}

// gap = normal·(tissue - point), where point = tissue - gap normal is the tool's.
struct Touch {
  Vec3 core = Vec3::Zero();  // the point of the core
  TrianglePoint tissue;
  Vec3 normal = Vec3::Zero();  // from tool to tissue, unit
  double gap = 0;
  // The core lies this far behind the triangle: a contact only if it is inside the tissue and this
  // triangle is the way out. 0 where nothing has to be asked.
  double depth = 0;
};

// Nothing for a triangle without area, or where gap >= margin or the touch is lost.
//
// Core in front of the triangle (it sees the outer side): the closest points and their direction.
// Core intersects it: a hull takes EPA's direction if that is within 60 degrees of -n, where n is
// the triangle's outward normal; else the direction is -n and the point is the deepest of the core
// straight below the triangle, but none where the triangle only ends at a side of the hull. Core
// behind it: that, too, or if nothing lies straight below, touch_of_points. A piece whose box is
// beyond the margin and which is in front of the triangle (a hull: its centre) does not touch it.
std::optional<Touch> touch(const PieceCore& core, const Triangle& triangle, double margin);

// A core behind the triangle and farther than this from it has lost the surface.
bool is_lost(const Touch& touch, double limit);

// Closest points, also from behind a facet of normal n. In front: d = (tissue - core) / distance
// and distance - radius. Behind, at depth s and with the distance l beside the facet: d mirrored at
// its plane, d - 2 (d·n) n, and the gap (l - radius) (1 + s / radius) as long as that is negative,
// then l - radius. This is -s - radius straight below a face, it equals the front's where s = 0,
// and vanishes where the core, moved back along n, would pass beside the facet: force and direction
// do not jump while a tool passes.
Touch touch_of_points(const Vec3& core, const TrianglePoint& tissue, const Vec3& n, double radius);

// A core point straight below the tissue's: direction -n, gap -depth - radius.
Touch touch_below(const Vec3& core, const TrianglePoint& tissue, const Vec3& n, double radius);

}  // namespace trocar
