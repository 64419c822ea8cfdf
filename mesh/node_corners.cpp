#include "mesh/node_corners.h"

#include <algorithm>

#include "base/check.h"
#include "base/sort_unique.h"

namespace trocar {

static void link(NodeCorners& corners, std::int32_t node, std::int32_t corner) {
  corners.next[corner] = corners.first[node];
  corners.first[node] = corner;
}

static void unlink(NodeCorners& corners, std::int32_t node, std::int32_t corner) {
  std::int32_t* at = &corners.first[node];
  while (*at != corner) {
    CHECK_OP(*at, >=, 0);
    at = &corners.next[*at];
  }
  *at = corners.next[corner];
}

NodeCorners node_corners(const Mesh& mesh) {
  NodeCorners corners{.first = std::vector<std::int32_t>(mesh.X.size(), -1),
                      .next = std::vector<std::int32_t>(mesh.corner_node.size()),
                      .element = {}};
  corners.element.reserve(mesh.corner_node.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (const std::int32_t node : mesh.corners(e)) {
      const auto corner = static_cast<std::int32_t>(corners.element.size());
      corners.element.push_back(e);
      link(corners, node, corner);
    }
  return corners;
}

void apply_edit(const MeshEdit& edit, const Mesh& before, NodeCorners& corners) {
  CHECK(edit.splits.empty());
  corners.first.resize(before.X.size() + edit.duplicate_parent.size(), -1);
  for (const CornerChange& change : edit.corners) {
    const std::int32_t corner = before.corner_offset[change.element] + change.corner;
    unlink(corners, before.corner_node[corner], corner);
    link(corners, change.node, corner);
  }
}

std::vector<std::int32_t> elements_around(const NodeCorners& corners,
                                          std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> elements;
  for (const std::int32_t node : nodes)
    for (std::int32_t at = corners.first[node]; at >= 0; at = corners.next[at])
      elements.push_back(corners.element[at]);
  sort_unique(elements);
  return elements;
}

std::vector<std::int32_t> edited_elements(const NodeCorners& before, const MeshEdit& edit) {
  CHECK(edit.splits.empty());
  std::vector<std::int32_t> moved;
  for (const NodeMove& move : edit.moves) moved.push_back(move.node);
  std::vector<std::int32_t> elements = elements_around(before, moved);
  for (const CornerChange& change : edit.corners) elements.push_back(change.element);
  for (const DensityChange& change : edit.density) elements.push_back(change.element);
  sort_unique(elements);
  return elements;
}

std::vector<std::int32_t> nodes_of(const Mesh& mesh, std::span<const std::int32_t> elements) {
  std::vector<std::int32_t> nodes;
  for (const std::int32_t e : elements)
    nodes.insert(nodes.end(), mesh.corners(e).begin(), mesh.corners(e).end());
  sort_unique(nodes);
  return nodes;
}

}  // namespace trocar
