// Which corners of elements are at each node, in linked lists: an edit of a few corners costs a few
// links, whatever the mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// In no order: neither the corners nor those of a node.
struct NodeCorners {
  std::vector<std::int32_t> first;    // (n_nodes) a corner at the node, -1: none
  std::vector<std::int32_t> next;     // (n_corners) another one at the same node, -1: no more
  std::vector<std::int32_t> element;  // (n_corners)
};
NodeCorners node_corners(const Mesh& mesh);
// `before` is the mesh before the edit.
void apply_edit(const MeshEdit& edit, const Mesh& before, NodeCorners& corners);

// Elements that the edit touches in any way (split, moved corner, changed corner, density) as they
// are before it, ascending.
std::vector<std::int32_t> edited_elements(const Mesh& mesh, const NodeCorners& before,
                                          const MeshEdit& edit);

// All elements that touch one of the nodes, ascending.
std::vector<std::int32_t> elements_around(const NodeCorners& corners,
                                          std::span<const std::int32_t> nodes);
// The same from a pass over all corners.
std::vector<std::int32_t> elements_around(const Mesh& mesh, std::span<const std::int32_t> nodes);
// All corners of the elements, ascending.
std::vector<std::int32_t> nodes_of(const Mesh& mesh, std::span<const std::int32_t> elements);

}  // namespace trocar
