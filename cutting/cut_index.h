// Elements around each node, kept from edit to edit, so that a cut never looks at the whole mesh.
// It only saves time: what is found with it is the same however old it is.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// A facet that looks for the element across: its nodes but the lowest, where it waits, its local
// element, and who waits there after it.
struct WaitingFacet {
  std::int32_t middle, high, element, facet, next;
};

struct CutIndex {
  std::vector<std::int32_t> star_begin, star_size;  // (n_nodes) into star_element
  std::vector<std::int32_t> star_element;           // ascending in each star
  // Nodes of facets with one element. Where tetrahedra lie on the quads of a hexahedron, these
  // quads' nodes count too. (n_nodes)
  std::vector<std::uint8_t> is_surface;
  // The tetrahedron across each facet of a tetrahedron, -1 if there is none, as far as patches have
  // found them. (n_elements)
  std::vector<std::array<std::int32_t, 4>> across;
  // Scratch of searches and patches (n_nodes; n_elements), the same value everywhere between two
  // uses.
  std::vector<std::uint8_t> ring;
  std::vector<std::int32_t> local, local_element;
  std::vector<WaitingFacet> waiting;  // scratch of patches, anything between two uses
  // Of the mesh that it belongs to; nullptr if that has yet to be edited as the index has been.
  const std::int32_t* corner_node = nullptr;
  std::size_t n_elements = 0;

  std::span<const std::int32_t> star(std::int32_t i) const {
    return {star_element.data() + star_begin[i], static_cast<std::size_t>(star_size[i])};
  }
};

inline constexpr std::uint8_t no_ring = 255;
inline constexpr std::int32_t not_known = -2;

bool is_index_of(const CutIndex& index, const Mesh& mesh);
// Builds the index anew if it isn't that of `mesh`: another mesh, or one that somebody else has cut
// (a cut adds nodes).
void update_index(const Mesh& mesh, CutIndex& index);
// Elements of the nodes' stars, ascending.
std::vector<std::int32_t> elements_around(const CutIndex& index,
                                          std::span<const std::int32_t> node);
// What the index will be once `edit`, one that splits elements or one that moves and parts them, is
// applied to `mesh`.
void edit_index(const Mesh& mesh, const MeshEdit& edit, CutIndex& index);

}  // namespace trocar
