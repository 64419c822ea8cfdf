// How good and how sound a mesh is.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/box.h"
#include "mesh/mesh.h"

namespace trocar {

// Mean-ratio quality in (0, 1], 1 for the ideal shape, <= 0 if inverted. tet4: 12 (3V)^(2/3) / sum
// l^2; tri3: 4 sqrt(3) A / sum l^2; hex8: least over the 8 corners of the mean ratio of the
// corner's tetrahedron (Knupp 2001), scaled to 1 for a cube.
double element_quality(ElementType type, std::span<const Vec3> x);  // (n_corners, or more)
double element_quality(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x);

// Least altitude of tri3 and tet4; for hex8 V / largest face area. [m]
double least_altitude(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x);

struct ElementStatistics {
  std::array<std::int32_t, n_element_types> n_elements_by_type{};
  double volume = 0;  // [m^3] ([m^2] in 2D)
  double quality_min = 0, quality_mean = 0;
  std::int32_t worst_element = 0;
};
ElementStatistics element_statistics(const Mesh& mesh);

// Mean length of the unique edges, in the reference configuration. [m]
double mean_edge_length(const Mesh& mesh);
// (n_regions) Files name regions, too, that have none.
std::vector<std::int64_t> elements_by_region(const Mesh& mesh);

struct PieceStatistics {
  std::int32_t n_pieces = 0;    // see count_pieces
  std::int32_t n_unjoined = 0;  // nodes of theirs, see count_unjoined; within 1e-6 mean edges
};
PieceStatistics piece_statistics(const Mesh& mesh);

// With what takes a look at all facets and edges; of meshes with broken facets, too.
struct MeshStatistics : ElementStatistics, PieceStatistics {
  std::int32_t n_nodes = 0, n_surface_triangles = 0;
  Box box{Vec3::Zero(), Vec3::Zero()};               // around it [m]
  double edge_min = 0, edge_mean = 0, edge_max = 0;  // [m]
};
MeshStatistics mesh_statistics(const Mesh& mesh);

// Every broken invariant, one sentence each, empty if the mesh is sound: corner numbers in range,
// no repeated corner, positive volume, finite positions, no unreferenced node, no facet of three
// elements or with both on one side, no duplicate element. At most `most` sentences.
std::vector<std::string> validate(const Mesh& mesh, int most = 20);

}  // namespace trocar
