// Which element holds a point. Of a hexahedron, the tetrahedron of hex_split.h that holds it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "mesh/mesh.h"

namespace trocar {

struct Location {
  std::int32_t element = -1;                 // -1: outside all elements
  std::array<double, max_corners> weight{};  // barycentric
};

// In positions x; the lowest element number wins on a border. n_elements box tests.
std::vector<Location> locate_points(const Mesh& mesh, std::span<const Vec3> x,
                                    std::span<const Vec3> points);
// The same where `near` (ascending) has all elements whose boxes overlap box_around(points).
std::vector<Location> locate_points(const Mesh& mesh, std::span<const Vec3> x,
                                    std::span<const Vec3> points,
                                    std::span<const std::int32_t> near);
// Of the points, and a little more than where they count as inside.
Box box_around(std::span<const Vec3> points);

// A part of a segment that lies in one element.
struct SegmentPiece {
  Location middle;
  double length = 0;  // [m]
};
// Where the segment from segment[0] to segment[1] is inside elements, in its order: pieces don't
// overlap, and of elements that share one the first that it enters has it, of the same place the
// lowest number. `near` as above, for the segment's ends.
std::vector<SegmentPiece> locate_segment(const Mesh& mesh, std::span<const Vec3> x,
                                         const std::array<Vec3, 2>& segment,
                                         std::span<const std::int32_t> near);

// Of one point; outside the body the element whose least weight is largest (extrapolated weights).
Location locate_nearest(const Mesh& mesh, std::span<const Vec3> x, const Vec3& point);
// sum of weight * field at the element's corners.
Vec3 interpolate(const Mesh& mesh, const Location& location, std::span<const Vec3> field);

}  // namespace trocar
