// From triangles that share nodes to vertices that can be drawn: normals are smooth within a sheet
// and split where the outer surface meets a cut face and along creases of the reference shape.
// Where colours meet, vertices are split and the sheet goes on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace trocar {

using Vec3f = Eigen::Vector3f;
inline Eigen::Map<const Vec3f> as_vector(const std::array<float, 3>& a) {
  return Eigen::Map<const Vec3f>(a.data());
}

// One vertex as the GPU gets it.
struct SurfaceVertex {
  std::array<float, 3> x;       // present position [m]
  std::array<float, 3> X;       // reference position [m]
  std::array<float, 3> normal;  // unit
  std::array<float, 3> colour;  // linear RGB
  std::array<std::uint8_t, 4>
      edge;  // 0…255: distance from the three edges, 255 where no edge is drawn; unused
  std::array<std::uint8_t, 4>
      mark;  // is_cut, on the rim between outer surface and cut face; unused
};

struct SurfaceMesh {
  std::vector<SurfaceVertex> vertex;
  std::vector<std::uint32_t>
      point;  // (n_vertices) vertices with the same number are one point of the surface
  std::vector<std::uint32_t> index;  // (3 * n_triangles)
};

// What to make vertices of. Positions that are not finite drop their triangles.
struct SurfaceShape {
  std::span<const Vec3> x, X;  // (n_nodes)
  std::span<const std::array<std::int32_t, 3>> triangle;
  std::span<const std::uint8_t> is_cut;  // (n_triangles), empty: no cut faces
  std::span<const Vec3> colour;          // (n_triangles) linear RGB, empty: black
  double crease_cosine = 0.64;           // of the angle from which on an edge is sharp (50 degrees)
};
SurfaceMesh make_surface_mesh(const SurfaceShape& shape);

// Each triangle in four, with new vertices on the curved surface that the normals tell of (Vlachos
// et al. 2001, Curved PN triangles, the middle of an edge). Leaves no gap at split vertices. With
// an eye, only edges near the outline that it sees are split: elsewhere the normals are curve
// enough.
SurfaceMesh refine_surface_mesh(const SurfaceMesh& mesh, const Vec3* eye = nullptr);

// Every triangle with three vertices of its own whose `edge` says how far the edges are.
// is_quad_half (n_triangles, or empty): 1 for both triangles of a quad, one after the other, whose
// diagonal from corner 0 is no edge: it lies across corner 1 of the first and 2 of the second.
SurfaceMesh mark_edges(const SurfaceMesh& mesh, std::span<const std::uint8_t> is_quad_half);

}  // namespace trocar
