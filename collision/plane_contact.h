// Contact of a plane mesh (tri3 in z = 0): a tool touches its boundary edges with the section that
// z = 0 cuts out of it, not its faces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/narrow_phase.h"
#include "mesh/facets.h"

namespace trocar {

// Boundary edges {a, b}, the inside to their left, ascending in (triangle, edge). A closed surface
// has none: that is what tells a plane mesh from the boundary of a body.
struct PlaneEdges {
  std::vector<std::array<std::int32_t, 2>> node;
  std::vector<std::int32_t> triangle;  // the edge's triangle in Surface::triangle
};
PlaneEdges boundary_edges(const Surface& surface);

// What z = 0 leaves of a piece. A point and a segment stay in space, as the centres of spheres of
// which each has its own circle in the plane; a hull becomes the polygon in which the plane cuts
// it. No points: the piece does not reach the plane.
struct PlaneSection {
  std::vector<Vec3> points;  // 1, 2, or a convex polygon, counter-clockwise
  double radius = 0;
  double thickness = 0;  // PieceCore::thickness
};
PlaneSection plane_section(const PieceCore& core, const Pose& pose);

// As touch() for triangles, in the plane: the third weight is 0, the core point lies in the plane.
std::optional<Touch> touch_edge(const PlaneSection& section, const Segment& edge, double margin);

// Of a point in the plane from the section, as that of narrow_phase.h from a piece.
SignedDistance signed_distance(const PlaneSection& section, const Vec3& x);

// Outward normal of the nearest edge that p lies behind, for a p inside the mesh; zero outside.
Vec3 plane_way_out(const PlaneEdges& edges, std::span<const Vec3> x, const Vec3& p);

}  // namespace trocar
