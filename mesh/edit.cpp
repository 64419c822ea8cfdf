// Applying a change of topology to a mesh and to nodal fields.
#include "mesh/edit.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "mesh/hex_split.h"

namespace trocar {

// Of splits that lie before element e.
static std::int32_t count_before(std::span<const HexSplit> splits, std::int32_t e) {
  const auto at =
      std::lower_bound(splits.begin(), splits.end(), e,
                       [](const HexSplit& split, std::int32_t k) { return split.element < k; });
  return static_cast<std::int32_t>(at - splits.begin());
}

std::int32_t SplitNumbers::after(std::int32_t before) const {
  return before + n_more_elements * count_before(splits_, before);
}

std::int32_t SplitNumbers::before(std::int32_t after) const {
  std::size_t low = 0, high = splits_.size();  // splits whose first tetrahedron is not behind it
  while (low < high) {
    const std::size_t k = low + (high - low) / 2;
    if (splits_[k].element + n_more_elements * static_cast<std::int32_t>(k) <= after)
      low = k + 1;
    else
      high = k;
  }
  const std::int32_t moved_up = after - n_more_elements * static_cast<std::int32_t>(low);
  return low > 0 ? std::max(moved_up, splits_[low - 1].element) : after;
}

const HexSplit* SplitNumbers::find(std::int32_t before) const {
  const auto k = static_cast<std::size_t>(count_before(splits_, before));
  return k < splits_.size() && splits_[k].element == before ? &splits_[k] : nullptr;
}

std::vector<std::int32_t> SplitNumbers::all_after(std::span<const std::int32_t> before) const {
  std::vector<std::int32_t> all;
  for (const std::int32_t e : before)
    for (std::int32_t k = 0; k < (is_split(e) ? n_hex_tets : 1); ++k) all.push_back(after(e) + k);
  return all;
}

void SplitNumbers::renumber(std::span<std::int32_t> elements) const {
  if (splits_.empty()) return;
  std::int32_t low = 0, high = -1, way = 0;  // of elements from low to high
  for (std::int32_t& e : elements) {
    if (e < low || e > high) {
      const std::int32_t k = count_before(splits_, e);
      low = k > 0 ? splits_[static_cast<std::size_t>(k - 1)].element + 1 : 0;
      high = k < std::ssize(splits_) ? splits_[static_cast<std::size_t>(k)].element
                                     : std::numeric_limits<std::int32_t>::max();
      way = n_more_elements * k;
    }
    e += way;
  }
}

std::vector<std::int32_t> element_parents(const Mesh& mesh, const MeshEdit& edit) {
  std::vector<std::int32_t> parent(mesh.element_type.size());
  std::iota(parent.begin(), parent.end(), 0);
  spread_over_splits(edit.splits, parent);
  return parent;
}

std::int32_t node_before(const MeshEdit& edit, const Mesh& before, const CornerChange& change) {
  const SplitNumbers numbers(edit.splits);
  const std::int32_t e = numbers.before(change.element);
  const auto corner = static_cast<std::size_t>(change.corner);
  const HexSplit* const split = numbers.find(e);
  if (split == nullptr) return before.corners(e)[corner];
  return split->corner[static_cast<std::size_t>(change.element - numbers.after(e))][corner];
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

static void split_corner_nodes(std::span<const HexSplit> splits, Mesh& mesh) {
  std::vector<std::int32_t>& node = mesh.corner_node;
  auto end = std::ssize(node);
  node.resize(node.size() + (4 * n_hex_tets - 8) * splits.size());
  auto to = node.end();
  for (auto split = splits.rbegin(); split != splits.rend(); ++split) {
    const std::int32_t first = mesh.corner_offset[split->element];
    to = std::move_backward(node.begin() + first + 8, node.begin() + end, to);
    end = first;
    for (auto tet = split->corner.rbegin(); tet != split->corner.rend(); ++tet)
      to = std::copy_backward(tet->begin(), tet->end(), to);
  }
}

static void split_hexahedra(std::span<const HexSplit> splits, Mesh& mesh) {
  if (splits.empty()) return;
  std::vector<std::uint8_t> cut_facets;
  for (const HexSplit& split : splits) {
    CHECK(mesh.element_type[split.element] == ElementType::hex8);
    for (const std::array<std::int32_t, 4>& tet : split.corner)
      cut_facets.push_back(inherited_cut_facets(mesh, split.element, tet));
  }
  split_corner_nodes(splits, mesh);
  spread_over_splits(splits, mesh.element_type);
  spread_over_splits(splits, mesh.element_region);
  spread_over_splits(splits, mesh.density_factor);
  spread_over_splits(splits, mesh.fibre);
  spread_over_splits(splits, mesh.cut_facets);
  const SplitNumbers numbers(splits);
  auto mask = cut_facets.begin();
  for (const HexSplit& split : splits) {
    const std::int32_t first = numbers.after(split.element);
    std::fill_n(mesh.element_type.begin() + first, n_hex_tets, ElementType::tet4);
    std::copy_n(mask, n_hex_tets, mesh.cut_facets.begin() + first);
    mask += n_hex_tets;
  }
  mesh.corner_offset.resize(mesh.element_type.size() + 1);
  for (std::int32_t e = splits.front().element; e < mesh.n_elements(); ++e)
    mesh.corner_offset[e + 1] = mesh.corner_offset[e] + n_corners(mesh.element_type[e]);
}

void apply_edit(const MeshEdit& edit, Mesh& mesh) {
  split_hexahedra(edit.splits, mesh);
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
