// Neighbours across facets (faces in 3D, edges in 2D), around nodes and along edges, and the
// boundary surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/grouped.h"
#include "mesh/element_shape.h"
#include "mesh/mesh.h"

namespace trocar {

// Which element lies across each facet; none where a hexahedron's quad meets two tetrahedra
// (hex_split.h).
struct FacetNeighbours {
  std::vector<std::int32_t> offset;     // (n_elements + 1)
  std::vector<std::int32_t> neighbour;  // (offset.back()) element across, or -1 on the boundary
  std::int32_t of(std::int32_t e, int f) const { return neighbour[offset[e] + f]; }
};
// Throws InputError if more than two elements share a facet.
FacetNeighbours facet_neighbours(const Mesh& mesh);

// Elements around each node, ascending.
using NodeElements = Grouped<std::int32_t>;
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
// What it is made of: facets of one element only, as bits by element.
std::vector<std::uint8_t> boundary_facets(const Mesh& mesh);
// Appends facet f of element e, but for the nodes.
void add_facet(Surface& surface, const Mesh& mesh, std::int32_t e, int f);

}  // namespace trocar
