// Applying a change of topology to a mesh and to nodal fields.
#include "mesh/edit.h"

#include <algorithm>

#include "base/check.h"

namespace trocar {

std::vector<std::int32_t> edited_elements(const Mesh& mesh, const MeshEdit& edit) {
  std::vector<std::uint8_t> is_moved(mesh.X.size(), 0), is_edited(mesh.element_type.size(), 0);
  for (const NodeMove& move : edit.moves) is_moved[move.node] = 1;
  for (const CornerChange& change : edit.corners) is_edited[change.element] = 1;
  for (const DensityChange& change : edit.density) is_edited[change.element] = 1;
  std::vector<std::int32_t> element;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> node = mesh.corners(e);
    if (is_edited[e] != 0 ||
        std::any_of(node.begin(), node.end(), [&](std::int32_t i) { return is_moved[i] != 0; }))
      element.push_back(e);
  }
  return element;
}

// A duplicate joins every set of its parent; new numbers are the highest, so the sets stay
// ascending.
static void extend_node_sets(std::span<const std::int32_t> duplicate_parent,
                             std::int32_t first_duplicate, std::vector<NodeSet>& sets) {
  for (NodeSet& set : sets)
    for (std::size_t k = 0; k < duplicate_parent.size(); ++k)
      if (std::binary_search(set.node.begin(), set.node.end(), duplicate_parent[k]))
        set.node.push_back(first_duplicate + static_cast<std::int32_t>(k));
}

void apply_edit(const MeshEdit& edit, Mesh& mesh) {
  const std::int32_t first_duplicate = mesh.n_nodes();
  for (const NodeMove& move : edit.moves) mesh.X[move.node] = move.X;
  for (const std::int32_t parent : edit.duplicate_parent) {
    CHECK(parent >= 0 && parent < mesh.n_nodes());
    const Vec3 X = mesh.X[parent];
    mesh.X.push_back(X);
  }
  extend_node_sets(edit.duplicate_parent, first_duplicate, mesh.node_sets);
  for (const CornerChange& change : edit.corners) {
    CHECK(change.node >= 0 && change.node < mesh.n_nodes());
    mesh.corner_node[mesh.corner_offset[change.element] + change.corner] = change.node;
  }
  for (const CutFacets& change : edit.cut_facets) mesh.cut_facets[change.element] = change.mask;
  for (const DensityChange& change : edit.density)
    mesh.density_factor[change.element] = change.factor;
}

// sum_a weight[a] q[corner a of host] for each moved node, all from the values before the edit.
static std::vector<double> moved_values(const MeshEdit& edit, const Mesh& before, int width,
                                        const std::vector<double>& field) {
  std::vector<double> value(edit.moves.size() * static_cast<std::size_t>(width), 0.0);
  double* q = value.data();
  for (const NodeMove& move : edit.moves) {
    const std::span<const std::int32_t> corner = before.corners(move.host);
    for (int component = 0; component < width; ++component, ++q)
      for (std::size_t a = 0; a < corner.size(); ++a)
        *q += move.weight[a] * field[static_cast<std::size_t>(corner[a]) * width + component];
  }
  return value;
}

void apply_edit(const MeshEdit& edit, const Mesh& before, int width, std::vector<double>& field) {
  CHECK_OP(field.size(), ==, before.X.size() * static_cast<std::size_t>(width));
  const std::vector<double> value = moved_values(edit, before, width, field);
  const auto at = [&](std::size_t node) {
    return field.begin() + static_cast<std::ptrdiff_t>(node) * width;
  };
  for (std::size_t k = 0; k < edit.moves.size(); ++k)
    std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(k) * width, width,
                at(static_cast<std::size_t>(edit.moves[k].node)));
  std::size_t n_nodes = before.X.size();
  field.resize((n_nodes + edit.duplicate_parent.size()) * static_cast<std::size_t>(width));
  for (const std::int32_t parent : edit.duplicate_parent) {
    CHECK(parent >= 0 && static_cast<std::size_t>(parent) < n_nodes);
    std::copy_n(at(static_cast<std::size_t>(parent)), width, at(n_nodes++));
  }
}

}  // namespace trocar
