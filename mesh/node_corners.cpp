#include "mesh/node_corners.h"

#include <algorithm>

#include "base/check.h"
#include "base/sort_unique.h"

namespace trocar {

static void link(NodeCorners& corners, std::int32_t node, std::int32_t corner) {
  corners.next[corner] = corners.first[node];
  corners.first[node] = corner;
}

// Returns the element's corner at the node.
static std::int32_t unlink(NodeCorners& corners, std::int32_t node, std::int32_t element) {
  std::int32_t* at = &corners.first[node];
  for (;; at = &corners.next[*at]) {
    CHECK_OP(*at, >=, 0);
    if (corners.element[*at] == element) break;
  }
  const std::int32_t corner = *at;
  *at = corners.next[corner];
  return corner;
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

static void split_elements(const SplitNumbers& numbers, std::span<const ElementSplit> splits,
                           const Mesh& before, NodeCorners& corners) {
  std::vector<std::int32_t> unused;
  for (const ElementSplit& split : splits)
    for (const std::int32_t node : before.corners(split.element))
      unused.push_back(unlink(corners, node, split.element));
  for (const ElementSplit& split : splits)
    for (std::int32_t k = 0; k < split.n_tets; ++k) {
      const std::int32_t part = numbers.part(split.element, k);
      for (const std::int32_t node : split.corner[k]) {
        if (unused.empty()) {
          unused.push_back(static_cast<std::int32_t>(corners.next.size()));
          corners.next.push_back(-1);
          corners.element.push_back(-1);
        }
        const std::int32_t corner = unused.back();
        unused.pop_back();
        corners.element[corner] = part;
        link(corners, node, corner);
      }
    }
}

void apply_edit(const MeshEdit& edit, const Mesh& before, NodeCorners& corners) {
  corners.first.resize(before.X.size() + edit.n_new_nodes(), -1);
  const SplitNumbers numbers(edit.splits, before.n_elements());
  split_elements(numbers, edit.splits, before, corners);
  for (const CornerChange& change : edit.corners)
    link(corners, change.node,
         unlink(corners, node_before(numbers, before, change), change.element));
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

std::vector<std::int32_t> elements_around(const Mesh& mesh, std::span<const std::int32_t> nodes) {
  std::vector<std::uint8_t> is_wanted(mesh.X.size());
  for (const std::int32_t node : nodes) is_wanted[node] = 1;
  std::vector<std::int32_t> elements;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (const std::int32_t node : mesh.corners(e))
      if (is_wanted[node] != 0) {
        elements.push_back(e);
        break;
      }
  return elements;
}

std::vector<std::int32_t> edited_elements(const Mesh& mesh, const NodeCorners& before,
                                          const MeshEdit& edit) {
  const SplitNumbers numbers(edit.splits, mesh.n_elements());
  std::vector<std::int32_t> elements = elements_around(before, moved_nodes(edit));
  for (const ElementSplit& split : edit.splits) elements.push_back(split.element);
  for (const CornerChange& change : edit.corners) elements.push_back(numbers.whole(change.element));
  for (const DensityChange& change : edit.density)
    elements.push_back(numbers.whole(change.element));
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
