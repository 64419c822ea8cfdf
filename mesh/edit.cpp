// Applying a change of topology to a mesh and to nodal fields.
#include "mesh/edit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "mesh/element_shape.h"
#include "mesh/hex_split.h"

namespace trocar {

Vec3 position_of(const Mesh& before, const EdgeNode& node) {
  const Vec3& X0 = before.X[node.end[0]];
  return X0 + node.s * (before.X[node.end[1]] - X0);
}

std::vector<DensityChange> keep_masses(std::span<const Reshaped> elements, std::size_t n_regions,
                                       double tolerance) {
  std::vector<double> before(n_regions, 0), after = before;
  for (const Reshaped& e : elements) {
    before[e.region] += e.factor * e.before;
    after[e.region] += e.factor * e.after;
  }
  std::vector<DensityChange> changes;
  for (const Reshaped& e : elements) {
    const double had = before[e.region], has = after[e.region];
    if (!(std::abs(had - has) <= tolerance * had))
      changes.push_back({e.element, e.factor * (had / has)});
  }
  return changes;
}

std::vector<std::int32_t> moved_nodes(const MeshEdit& edit) {
  std::vector<std::int32_t> nodes;
  for (const NodeMove& move : edit.moves) nodes.push_back(move.node);
  return nodes;
}

std::int32_t n_added(std::span<const ElementSplit> splits) {
  std::int32_t n = 0;
  for (const ElementSplit& split : splits) n += split.n_tets - 1;
  return n;
}

SplitNumbers::SplitNumbers(std::span<const ElementSplit> splits, std::int32_t n_before)
    : splits_(splits), n_before_(n_before) {
  std::int32_t n = 0;
  for (const ElementSplit& split : splits) {
    n_added_.push_back(n);
    n += split.n_tets - 1;
  }
}

const ElementSplit* SplitNumbers::find(std::int32_t element) const {
  const auto at = std::ranges::lower_bound(splits_, element, {}, &ElementSplit::element);
  return at != splits_.end() && at->element == element ? &*at : nullptr;
}

std::int32_t SplitNumbers::part(std::int32_t element, std::int32_t k) const {
  if (k == 0) return element;
  return n_before_ + n_added_[find(element) - splits_.data()] + k - 1;
}

const ElementSplit& SplitNumbers::split_of_added(std::int32_t part) const {
  const auto behind = std::ranges::upper_bound(n_added_, part - n_before_);
  return splits_[behind - n_added_.begin() - 1];
}

std::int32_t SplitNumbers::whole(std::int32_t part) const {
  return part < n_before_ ? part : split_of_added(part).element;
}

std::int32_t SplitNumbers::place_in_whole(std::int32_t part) const {
  return part < n_before_ ? 0 : part - this->part(whole(part), 1) + 1;
}

std::vector<std::int32_t> SplitNumbers::all_after(std::span<const std::int32_t> elements) const {
  std::vector<std::int32_t> all(elements.begin(), elements.end());
  for (const std::int32_t e : elements)
    if (const ElementSplit* const split = find(e))
      for (std::int32_t k = 1; k < split->n_tets; ++k) all.push_back(part(e, k));
  return all;
}

std::int32_t node_before(const SplitNumbers& numbers, const Mesh& before,
                         const CornerChange& change) {
  const std::int32_t e = numbers.whole(change.element);
  const auto corner = static_cast<std::size_t>(change.corner);
  const ElementSplit* const split = numbers.find(e);
  if (split == nullptr) return before.corners(e)[corner];
  return split->corner[numbers.place_in_whole(change.element)][corner];
}

std::int32_t node_after(const MeshEdit& edit, const Mesh& before, std::int32_t e,
                        std::int32_t corner) {
  const std::pair wanted(e, corner);
  const auto key = [](const CornerChange& c) { return std::pair(c.element, c.corner); };
  const auto at = std::ranges::lower_bound(edit.corners, wanted, {}, key);
  return at != edit.corners.end() && key(*at) == wanted ? at->node : before.corners(e)[corner];
}

std::uint8_t cut_facets_after(const MeshEdit& edit, const Mesh& before, std::int32_t e) {
  const auto at = std::ranges::lower_bound(edit.cut_facets, e, {}, &CutFacets::element);
  return at != edit.cut_facets.end() && at->element == e ? at->mask : before.cut_facets[e];
}

// Node `node` on an edge joins the sets of both ends; of a facet that was left out both halves are,
// in no order yet.
static void extend_node_sets(const EdgeNode& inserted, std::int32_t node,
                             std::vector<NodeSet>& sets) {
  const auto [a, b] = inserted.end;
  for (NodeSet& set : sets) {
    if (std::binary_search(set.node.begin(), set.node.end(), a) &&
        std::binary_search(set.node.begin(), set.node.end(), b))
      set.node.push_back(node);
    std::vector<FacetNodes> halves;
    for (FacetNodes& facet : set.left_out) {
      if (std::ranges::count(facet, a) + std::ranges::count(facet, b) < 2) continue;
      halves.push_back(facet);
      std::ranges::replace(facet, a, node);
      std::ranges::replace(halves.back(), b, node);
      std::ranges::sort(facet);
      std::ranges::sort(halves.back());
    }
    set.left_out.insert(set.left_out.end(), halves.begin(), halves.end());
  }
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

static void insert_nodes(std::span<const EdgeNode> inserted, Mesh& mesh) {
  for (const EdgeNode& node : inserted) {
    const std::int32_t number = mesh.n_nodes();
    CHECK_OP(node.end[0], <, node.end[1]);
    CHECK_OP(node.end[1], <, number);
    const Vec3 X = position_of(mesh, node);
    mesh.X.push_back(X);
    mesh.copied_node.push_back(number);
    extend_node_sets(node, number, mesh.node_sets);
  }
  if (inserted.empty()) return;
  for (NodeSet& set : mesh.node_sets) std::ranges::sort(set.left_out);
}

// The facet of tetrahedron `whole` that facet f of a part of it lies on, -1 if inside. Nodes from
// first_inserted on lie on edges.
static int tet_facet_of(std::span<const std::int32_t> whole, std::span<const EdgeNode> inserted,
                        std::int32_t first_inserted, const std::array<std::int32_t, 4>& tet,
                        int f) {
  const auto touches = [&](std::int32_t node, std::int32_t corner) {
    if (node == corner) return true;
    const std::int32_t k = node - first_inserted;
    return k >= 0 && std::ranges::count(inserted[k].end, corner) > 0;
  };
  for (int g = 0; g < 4; ++g) {
    bool is_on = true;
    for (int c = 0; c < 4; ++c) is_on = is_on && (c == f || !touches(tet[c], whole[g]));
    if (is_on) return g;
  }
  return -1;
}

std::uint8_t facets_of_part(std::span<const std::int32_t> whole, std::uint8_t mask,
                            std::span<const EdgeNode> inserted, std::int32_t first_inserted,
                            const std::array<std::int32_t, 4>& part) {
  return tet_facets_on(
      mask, [&](int f) { return tet_facet_of(whole, inserted, first_inserted, part, f); });
}

// A hexahedron leaves room for the corners of two tetrahedra.
static void split_corners(const ElementSplit& split, Mesh& mesh) {
  const std::int32_t own = mesh.corner_offset[split.element],
                     room = mesh.element_type[split.element] == ElementType::hex8 ? 2 : 1;
  for (std::int32_t k = 0; k < split.n_tets; ++k) {
    const auto n_all = static_cast<std::int32_t>(mesh.corner_node.size());
    const std::int32_t first = k < room ? own + 4 * k : n_all;
    if (first == n_all) mesh.corner_node.resize(mesh.corner_node.size() + 4);
    std::ranges::copy(split.corner[k], &mesh.corner_node[first]);
    if (k > 0) mesh.corner_offset.push_back(first);
  }
}

// values (n_elements, or empty): parts get that of their element.
template <class T>
static void append_parts(const ElementSplit& split, std::vector<T>& values) {
  if (values.empty()) return;
  const T value = values[split.element];
  values.insert(values.end(), static_cast<std::size_t>(split.n_tets - 1), value);
}

static void split_element(const MeshEdit& edit, const ElementSplit& split, Mesh& mesh) {
  const std::int32_t e = split.element, n_before = mesh.n_elements(),
                     first_inserted =
                         mesh.n_nodes() - static_cast<std::int32_t>(edit.inserted.size());
  const bool is_hex = mesh.element_type[e] == ElementType::hex8;
  CHECK(is_hex || mesh.element_type[e] == ElementType::tet4);
  std::vector<std::uint8_t> cut_facets;
  for (const std::array<std::int32_t, 4>& tet : split.tets())
    cut_facets.push_back(is_hex ? cut_facets_in_hex(mesh, e, tet)
                                : facets_of_part(mesh.corners(e), mesh.cut_facets[e], edit.inserted,
                                                 first_inserted, tet));
  if (is_hex) mesh.split_hexahedra.push_back({e, n_before});
  split_corners(split, mesh);
  mesh.element_type[e] = ElementType::tet4;
  append_parts(split, mesh.element_type);
  append_parts(split, mesh.element_region);
  append_parts(split, mesh.density_factor);
  append_parts(split, mesh.fibre);
  mesh.cut_facets[e] = cut_facets.front();
  mesh.cut_facets.insert(mesh.cut_facets.end(), cut_facets.begin() + 1, cut_facets.end());
}

void apply_edit(const MeshEdit& edit, Mesh& mesh) {
  insert_nodes(edit.inserted, mesh);
  for (const ElementSplit& split : edit.splits) split_element(edit, split, mesh);
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
  std::size_t n_nodes = before.X.size();
  field.resize((n_nodes + edit.n_new_nodes()) * static_cast<std::size_t>(width));
  for (const EdgeNode& node : edit.inserted) {
    const auto q0 = at(static_cast<std::size_t>(node.end[0])),
               q1 = at(static_cast<std::size_t>(node.end[1]));
    std::transform(q0, q0 + width, q1, at(n_nodes++),
                   [&](double a, double b) { return a + node.s * (b - a); });
  }
  for (std::size_t k = 0; k < edit.moves.size(); ++k)
    std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(k) * width, width,
                at(static_cast<std::size_t>(edit.moves[k].node)));
  for (const std::int32_t parent : edit.duplicate_parent) {
    CHECK(parent >= 0 && static_cast<std::size_t>(parent) < n_nodes);
    std::copy_n(at(static_cast<std::size_t>(parent)), width, at(n_nodes++));
  }
}

}  // namespace trocar
