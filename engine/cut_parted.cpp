#include "engine/cut_parted.h"

#include <algorithm>

#include "base/box.h"
#include "mesh/element_boxes.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr double least_cosine = 0.5;  // of the segment to the facet's normal
constexpr double slack = 1e-9;        // barycentric: no segment slips between two facets

bool passes(const std::array<Vec3, 3>& triangle, const std::array<Vec3, 2>& segment) {
  const Vec3 p = triangle[1] - triangle[0], q = triangle[2] - triangle[0], n = p.cross(q);
  const Vec3 way = segment[1] - segment[0];
  if (std::abs(n.dot(way)) < least_cosine * n.norm() * way.norm()) return false;
  const double from = n.dot(segment[0] - triangle[0]), to = n.dot(segment[1] - triangle[0]);
  if (from == to || (from < 0) == (to < 0)) return false;
  const Vec3 at = segment[0] + from / (from - to) * way - triangle[0];
  const double v = n.dot(at.cross(q)) / n.squaredNorm(), w = n.dot(p.cross(at)) / n.squaredNorm();
  return v >= -slack && w >= -slack && v + w <= 1 + slack;
}

// A triangle's edge as a strip across the plane, so that all facets are polygons.
std::array<Vec3, 4> corners_of(const Mesh& mesh, std::int32_t e, int f) {
  const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
  std::array<Vec3, 4> X{};
  for (std::size_t a = 0; a < 4; ++a)
    if (corner[a] >= 0) X[a] = mesh.X[mesh.corners(e)[corner[a]]];
  if (corner[3] < 0) X[3] = X[2];
  if (corner[2] >= 0) return X;
  const Vec3 height = (X[1] - X[0]).norm() * Vec3::UnitZ();
  return {X[0] - height, X[1] - height, X[1] + height, X[0] + height};
}

bool passes_facet(const Mesh& mesh, std::int32_t e, int f, const std::array<Vec3, 2>& segment) {
  const std::array<Vec3, 4> X = corners_of(mesh, e, f);
  return passes({X[0], X[1], X[2]}, segment) || passes({X[0], X[2], X[3]}, segment);
}

bool passes_cut_facet(const Mesh& mesh, std::int32_t e, const std::array<Vec3, 2>& segment) {
  const unsigned mask = mesh.cut_facets[e];
  for (int f = 0; mask >> f != 0; ++f)
    if ((mask >> f & 1) != 0 && passes_facet(mesh, e, f, segment)) return true;
  return false;
}

}  // namespace

bool is_parted(const Mesh& mesh, std::span<const std::int32_t> near,
               const std::array<Vec3, 2>& segment) {
  const Box box = bounding_box(segment);
  return std::ranges::any_of(near, [&](std::int32_t e) {
    return mesh.cut_facets[e] != 0 &&
           element_box(mesh, e, mesh.X).overlaps(box, slack * box.size().norm()) &&
           passes_cut_facet(mesh, e, segment);
  });
}

}  // namespace trocar
