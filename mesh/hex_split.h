// Hexahedra as six tetrahedra on the same nodes, so that neighbours agree without asking each
// other; and the quads where a hexahedron and tetrahedra meet.
//
// Such a quad is conforming in its nodes; inside it, the bilinear field of the hexahedron and the
// piecewise linear one of the triangles differ unless the field is linear.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/edit.h"
#include "mesh/facet_sort.h"
#include "mesh/mesh.h"

namespace trocar {

// Of Mesh::hex_split_rank.
inline constexpr std::uint8_t rank_bits = 127, whole_bit = 128;

// Whether a facet's diagonal begins at node i rather than at j: at that of the higher rank, else of
// the lower number. A copy counts as the node that it was copied from: cuts don't turn diagonals.
bool is_diagonal_at(const Mesh& mesh, std::int32_t i, std::int32_t j);

// (n_nodes) Ranks 0 … 127 that grow with how nearly facets of the hexahedra around lie in one plane
// with their neighbours at an edge, as where a grid is bent to a ball: with diagonals that begin at
// its ends no tetrahedron has all of its nodes in that plane.
std::vector<std::uint8_t> diagonal_ranks(const Mesh& mesh);

// Local corners of the six tetrahedra of hexahedron e: each facet has its diagonal at the first of
// its nodes (Dompierre et al. 1999, "How to subdivide pyramids, prisms and hexahedra into
// tetrahedra", has the lowest number).
std::array<std::array<int, 4>, n_hex_tets> hex_tets(const Mesh& mesh, std::int32_t e);
// The nodes of one of them, and of all.
std::array<std::int32_t, 4> tet_nodes(const Mesh& mesh, std::int32_t e,
                                      const std::array<int, 4>& tet);
std::array<std::array<std::int32_t, 4>, n_hex_tets> hex_tet_nodes(const Mesh& mesh, std::int32_t e);

// The facet of hexahedron e that facet f of a tetrahedron on its nodes lies on, -1 if inside.
int hex_facet_of(const Mesh& mesh, std::int32_t e, const std::array<std::int32_t, 4>& tet, int f);
// Bits of the facets of such a tetrahedron that lie on opened facets of the hexahedron.
std::uint8_t facets_of_hex(const Mesh& mesh, std::int32_t e,
                           const std::array<std::int32_t, 4>& tet);

// A quad that two triangles on the same four nodes cover from the other side.
struct SplitQuad {
  std::int32_t hex = 0, facet = 0;
  std::array<FacetSide, 2> triangle;
};
// All of them, ascending by (lowest node, …). `single`: single_sides(mesh).
std::vector<SplitQuad> split_quads(const Mesh& mesh, std::span<const FacetSide> single);

}  // namespace trocar
