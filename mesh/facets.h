// Facets of elements (faces in 3D, edges in 2D), neighbours across them, and the boundary surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// Local corners of facet f of an element, outward normal by the right-hand rule; -1 fills up.
// tet4: facet f is opposite to corner f. tri3: facet f is the edge opposite to corner f, {a, b}
// with the inside to its left. hex8: bottom, top, front, right, back, left.
std::array<int, 4> facet_corners(ElementType type, int f);
int n_facets(ElementType type);
inline constexpr std::array<std::array<int, 3>, 4> tet_facets{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// Which element lies across each facet.
struct FacetNeighbours {
  std::vector<std::int32_t> offset;     // (n_elements + 1)
  std::vector<std::int32_t> neighbour;  // (offset.back()) element across, or -1 on the boundary
  // A hexahedron's quad may have two tetrahedra across it (hex_split.h): the second of them, as
  // (hexahedron, tetrahedron), ascending.
  std::vector<std::array<std::int32_t, 2>> second;
  std::int32_t of(std::int32_t e, int f) const { return neighbour[offset[e] + f]; }
};
// Throws InputError if more than two elements share a facet.
FacetNeighbours facet_neighbours(const Mesh& mesh);

// Elements around each node, ascending.
struct NodeElements {
  std::vector<std::int32_t> offset;  // (n_nodes + 1)
  std::vector<std::int32_t> element;
  std::span<const std::int32_t> of(std::int32_t node) const {
    return {element.data() + offset[node],
            static_cast<std::size_t>(offset[node + 1] - offset[node])};
  }
};
NodeElements node_elements(const Mesh& mesh);

// Unique edges (a < b), ascending.
std::vector<std::array<std::int32_t, 2>> mesh_edges(const Mesh& mesh);

// The boundary as triangles in ascending order of (element, facet); a quad is split as
// hex_tets has it. A plane mesh (tri3) is its own surface: all elements, in order.
struct Surface {
  std::vector<std::array<std::int32_t, 3>> triangle;  // node numbers, outward
  std::vector<std::int32_t> element;                  // (n_triangles) behind each triangle
  std::vector<std::uint8_t> is_cut;  // (n_triangles) opened by a cut: the inside of the tissue
  // (n_triangles) one of the two of a quad, which come one after the other with the diagonal from
  // node 0 of both.
  std::vector<std::uint8_t> is_quad_half;
  std::vector<std::int32_t> node;  // nodes on the surface, ascending
};
Surface boundary_surface(const Mesh& mesh);

}  // namespace trocar
