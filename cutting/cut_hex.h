// Hexahedra in a cut. The cut sees each one as the six tetrahedra of mesh/hex_split.h, and cuts a
// body of tetrahedra only; what it decided goes back to the body: a hexahedron that no facet has
// been opened through and that is a sound element in its new shape stays one, the others become
// their tetrahedra. So a cut near the faces of a grid displaces, one across them converts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_figures.h"
#include "cutting/cut_index.h"
#include "cutting/cut_positions.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// The body with its hexahedra as tetrahedra. Nodes are those of the body; elements are in the order
// of the uncut body's, six for a hexahedron, so that numbers stay when one is converted.
struct HexTets {
  Mesh mesh;
  std::vector<std::int32_t> first;   // (n_elements of the body) of its elements in `mesh`
  std::vector<std::int32_t> source;  // (n_elements) element of the body

  // Whether element e of the body is a hexahedron that has its tetrahedra in `mesh`.
  bool is_hexahedron(std::int32_t e) const {
    const std::size_t next = static_cast<std::size_t>(first[e]) + 1;
    return next < source.size() && source[next] == e;
  }
  // Behind the last of its elements in `mesh`.
  std::int32_t end(std::int32_t e) const { return first[e] + (is_hexahedron(e) ? n_hex_tets : 1); }
};

// Whether it has hexahedra, or had some that are tetrahedra now.
bool was_hexahedral(const Mesh& mesh);

// Mesh::hex_split_rank of an uncut mesh, empty where all is zero. Whole stay hexahedra of which a
// tetrahedron would allow less than 0.15 of their step.
std::vector<std::uint8_t> hex_split_ranks(const Mesh& mesh);

// Hexahedra that can't be seen as tetrahedra: one would be inverted, or tetrahedra that lie on a
// facet of theirs have the other diagonal, or Mesh::hex_split_rank says so of all nodes. They stay
// whole, with all their nodes; ascending.
std::vector<std::int32_t> whole_hexahedra(const Mesh& mesh);

// Nodes of hexahedra that may not become tetrahedra at their present positions, as one would be
// inverted or nearly flat there; of those that elements of tets.mesh (ascending) belong to.
std::vector<std::int32_t> bent_nodes(const HexTets& tets, PresentPositions& positions,
                                     std::span<const std::int32_t> element);

// Whether `tets` are of the body, as far as numbers tell: edits that keep these only move nodes.
bool are_tets_of(const HexTets& tets, const Mesh& body);

// Brings `tets` up to date with the body; built anew where somebody else has changed the body.
void update_hex_tets(const Mesh& body, HexTets& tets);

// An edit of tets.mesh, which splits these of the body's hexahedra, taken over into `tets`.
void edit_hex_tets(std::span<const ElementSplit> splits, const MeshEdit& edit, HexTets& tets);

// `edit` of tets.mesh as one of the body; `index` is that of tets.mesh after the edit. Mass is kept
// region by region. Takes the edit over into `tets`, but not into `index`.
MeshEdit edit_of_body(const Mesh& body, PresentPositions& positions, const CutIndex& index,
                      const MeshEdit& edit, HexTets& tets, CutFigures& figures);

}  // namespace trocar
