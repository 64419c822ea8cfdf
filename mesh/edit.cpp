// Applying a change of topology to a mesh and to nodal fields.
#include "mesh/edit.h"

#include <algorithm>

#include "base/check.h"
#include "mesh/hex_split.h"

namespace trocar {

std::vector<std::int32_t> element_parents(const Mesh& mesh, const MeshEdit& edit) {
  std::vector<std::int32_t> parent;
  parent.reserve(mesh.element_type.size() + 5 * edit.splits.size());
  auto split = edit.splits.begin();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const bool is_split = split != edit.splits.end() && split->element == e;
    parent.insert(parent.end(), is_split ? split++->corner.size() : 1, e);
  }
  return parent;
}

std::vector<std::int32_t> edited_elements(const Mesh& mesh, const MeshEdit& edit) {
  const std::vector<std::int32_t> parent = element_parents(mesh, edit);
  std::vector<std::uint8_t> is_moved(mesh.X.size(), 0), is_edited(mesh.element_type.size(), 0);
  for (const HexSplit& split : edit.splits) is_edited[split.element] = 1;
  for (const NodeMove& move : edit.moves) is_moved[move.node] = 1;
  for (const CornerChange& change : edit.corners) is_edited[parent[change.element]] = 1;
  for (const DensityChange& change : edit.density) is_edited[parent[change.element]] = 1;
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

// Bits of the facets of tetrahedron `tet` (nodes) that lie on marked facets of hexahedron e.
static std::uint8_t inherited_cut_facets(const Mesh& mesh, std::int32_t e,
                                         const std::array<std::int32_t, 4>& tet) {
  unsigned mask = 0;
  for (int f = 0; f < 4 && mesh.cut_facets[e] != 0; ++f) {
    const int g = hex_facet_of(mesh, e, tet, f);
    if (g >= 0 && (mesh.cut_facets[e] >> g & 1) != 0) mask |= 1U << f;
  }
  return static_cast<std::uint8_t>(mask);
}

template <class T>
static void spread_to_children(std::span<const std::int32_t> parent, std::vector<T>& values) {
  if (values.empty()) return;
  std::vector<T> spread;
  spread.reserve(parent.size());
  for (const std::int32_t e : parent) spread.push_back(values[static_cast<std::size_t>(e)]);
  values = std::move(spread);
}

static void split_hexahedra(const MeshEdit& edit, Mesh& mesh) {
  if (edit.splits.empty()) return;
  const std::vector<std::int32_t> parent = element_parents(mesh, edit);
  std::vector<ElementType> type;
  std::vector<std::int32_t> offset{0}, node;
  std::vector<std::uint8_t> cut_facets;
  auto split = edit.splits.begin();
  const auto add = [&](ElementType element, std::span<const std::int32_t> corner,
                       std::uint8_t mask) {
    type.push_back(element);
    node.insert(node.end(), corner.begin(), corner.end());
    offset.push_back(static_cast<std::int32_t>(node.size()));
    cut_facets.push_back(mask);
  };
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (split == edit.splits.end() || split->element != e) {
      add(mesh.element_type[e], mesh.corners(e), mesh.cut_facets[e]);
      continue;
    }
    CHECK(mesh.element_type[e] == ElementType::hex8);
    for (const std::array<std::int32_t, 4>& tet : split->corner)
      add(ElementType::tet4, tet, inherited_cut_facets(mesh, e, tet));
    ++split;
  }
  mesh.element_type = std::move(type);
  mesh.corner_offset = std::move(offset);
  mesh.corner_node = std::move(node);
  mesh.cut_facets = std::move(cut_facets);
  spread_to_children(parent, mesh.element_region);
  spread_to_children(parent, mesh.density_factor);
  spread_to_children(parent, mesh.fibre);
}

void apply_edit(const MeshEdit& edit, Mesh& mesh) {
  split_hexahedra(edit, mesh);
  const std::int32_t first_duplicate = mesh.n_nodes();
  for (const NodeMove& move : edit.moves) mesh.X[move.node] = move.X;
  for (const std::int32_t parent : edit.duplicate_parent) {
    CHECK(parent >= 0 && parent < mesh.n_nodes());
    const Vec3 X = mesh.X[parent];
    const std::int32_t uncut = mesh.uncut_node(parent);
    mesh.X.push_back(X);
    mesh.copied_node.push_back(uncut);
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
