// Stars in one pool; a copied node's star is appended.
#include "cutting/cut_index.h"

#include <algorithm>

#include "mesh/facets.h"

namespace trocar {

static double longest_edge(const Mesh& mesh) {
  double longest = 0;  // squared; diagonals of hexahedra count as edges
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> c = mesh.corners(e);
    for (std::size_t a = 0; a < c.size(); ++a)
      for (std::size_t b = a + 1; b < c.size(); ++b)
        longest = std::max(longest, (mesh.X[c[a]] - mesh.X[c[b]]).squaredNorm());
  }
  return std::sqrt(longest);
}

void update_index(const Mesh& mesh, CutIndex& index) {
  if (index.star_begin.size() == mesh.X.size() && index.n_elements == mesh.element_type.size() &&
      index.corner_node == mesh.corner_node.data())
    return;
  NodeElements around = node_elements(mesh);
  index.star_begin.assign(around.offset.begin(), around.offset.end() - 1);
  index.star_size.resize(mesh.X.size());
  for (std::size_t i = 0; i < mesh.X.size(); ++i)
    index.star_size[i] = around.offset[i + 1] - around.offset[i];
  index.star_element = std::move(around.element);
  index.longest_edge = longest_edge(mesh);
  index.ring.assign(mesh.X.size(), no_ring);
  index.local.assign(mesh.X.size(), -1);
  index.corner_node = mesh.corner_node.data();
  index.n_elements = mesh.element_type.size();
}

static void remove_from_star(CutIndex& index, std::int32_t node, std::int32_t element) {
  const auto begin = index.star_element.begin() + index.star_begin[node];
  const auto end = begin + index.star_size[node];
  const auto at = std::lower_bound(begin, end, element);
  std::copy(at + 1, end, at);
  --index.star_size[node];
}

void edit_index(const Mesh& mesh, const MeshEdit& edit, CutIndex& index) {
  std::vector<CornerChange> change = edit.corners;
  std::stable_sort(change.begin(), change.end(), [](const CornerChange& a, const CornerChange& b) {
    return a.node != b.node ? a.node < b.node : a.element < b.element;
  });
  const std::size_t n_nodes = mesh.X.size() + edit.duplicate_parent.size();
  index.star_begin.resize(n_nodes);
  index.star_size.resize(n_nodes, 0);
  index.ring.resize(n_nodes, no_ring);
  index.local.resize(n_nodes, -1);
  for (const CornerChange& c : change) {
    remove_from_star(index, mesh.corners(c.element)[static_cast<std::size_t>(c.corner)], c.element);
    if (index.star_size[c.node]++ == 0)
      index.star_begin[c.node] = static_cast<std::int32_t>(index.star_element.size());
    index.star_element.push_back(c.element);
  }
}

}  // namespace trocar
