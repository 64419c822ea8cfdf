// Stars in one pool; a copied node's star is appended.
#include "cutting/cut_index.h"

#include <algorithm>
#include <array>

#include "base/digest.h"
#include "base/sort_unique.h"
#include "cutting/cut_patch.h"
#include "mesh/facets.h"

namespace trocar {

bool is_index_of(const CutIndex& index, const Mesh& mesh) {
  return index.star_begin.size() == mesh.X.size() && index.n_elements == mesh.element_type.size() &&
         (index.corner_node == nullptr || index.corner_node == mesh.corner_node.data());
}

// A number for the facet, whatever the order of its nodes.
static std::uint64_t facet_key(std::span<const std::int32_t> corner, const std::array<int, 4>& f) {
  std::array<std::int32_t, 4> node{-1, -1, -1, -1};
  for (std::size_t k = 0; k < 4; ++k)
    if (f[k] >= 0) node[k] = corner[f[k]];
  std::sort(node.begin(), node.end());
  return digest_item(0, node);
}

// At an inner node every facet comes twice, so that the keys of the facets around it cancel. (Ten
// times as fast as pairing the facets; keys that cancel by chance: 2^-64 a node.)
static void find_surface_nodes(const Mesh& mesh, CutIndex& index) {
  std::vector<std::uint64_t> sum(mesh.X.size(), 0);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> corner = mesh.corners(e);
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f) {
      const std::array<int, 4> facet = facet_corners(mesh.element_type[e], f);
      const std::uint64_t key = facet_key(corner, facet);
      for (const int c : facet)
        if (c >= 0) sum[corner[c]] ^= key;
    }
  }
  index.is_surface.assign(mesh.X.size(), 0);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) index.is_surface[i] = sum[i] != 0 ? 1 : 0;
}

// For what copies add, so that no cut moves whole vectors.
template <class T>
static void leave_room(std::vector<T>& values) {
  values.reserve(values.size() + values.size() / 4);
}

void update_index(const Mesh& mesh, CutIndex& index) {
  if (is_index_of(index, mesh)) {
    index.corner_node = mesh.corner_node.data();
    return;
  }
  NodeElements around = node_elements(mesh);
  index.star_begin.assign(around.offset.begin(), around.offset.end() - 1);
  index.star_size.resize(mesh.X.size());
  for (std::size_t i = 0; i < mesh.X.size(); ++i)
    index.star_size[i] = around.offset[i + 1] - around.offset[i];
  index.star_element = std::move(around.item);
  find_surface_nodes(mesh, index);
  index.ring.assign(mesh.X.size(), no_ring);
  index.local.assign(mesh.X.size(), -1);
  index.across.assign(mesh.element_type.size(), {not_known, not_known, not_known, not_known});
  index.local_element.assign(mesh.element_type.size(), -1);
  index.corner_node = mesh.corner_node.data();
  index.n_elements = mesh.element_type.size();
  for (auto* values : {&index.star_begin, &index.star_size, &index.local, &index.star_element,
                       &index.local_element})
    leave_room(*values);
  for (auto* values : {&index.ring, &index.is_surface}) leave_room(*values);
  leave_room(index.across);
}

// What lies across the facets of element e will be looked for again.
static void forget_across(CutIndex& index, std::int32_t e) {
  for (std::int32_t& u : index.across[e]) {
    if (u >= 0) std::ranges::replace(index.across[u], e, not_known);
    u = not_known;
  }
}

static void remove_from_star(CutIndex& index, std::int32_t node, std::int32_t element) {
  const auto begin = index.star_element.begin() + index.star_begin[node];
  const auto end = begin + index.star_size[node];
  const auto at = std::lower_bound(begin, end, element);
  std::copy(at + 1, end, at);
  --index.star_size[node];
}

static void add_opened_facets(const Mesh& mesh, const MeshEdit& edit, CutIndex& index) {
  for (const CutFacets& opened : edit.cut_facets)
    for (int f = 0; f < n_facets(mesh.element_type[opened.element]); ++f) {
      if ((opened.mask >> f & 1) == 0) continue;
      for (const int c : facet_corners(mesh.element_type[opened.element], f))
        if (c >= 0) index.is_surface[node_after(edit, mesh, opened.element, c)] = 1;
    }
}

static void add_nodes(std::size_t n_nodes, CutIndex& index) {
  index.star_begin.resize(n_nodes);
  index.star_size.resize(n_nodes, 0);
  index.ring.resize(n_nodes, no_ring);
  index.local.resize(n_nodes, -1);
  index.is_surface.resize(n_nodes, 0);
}

namespace {

// A part of a split element at one of its nodes.
struct NodePart {
  std::int32_t node, element;
  const std::array<std::int32_t, 4>* corner;
};

}  // namespace

// Ascending by node, then by element.
static std::vector<NodePart> parts_at_nodes(const MeshEdit& edit, const SplitNumbers& numbers) {
  std::vector<NodePart> parts;
  for (const ElementSplit& split : edit.splits)
    for (std::int32_t k = 0; k < split.n_tets; ++k) {
      const std::array<std::int32_t, 4>& corner = split.corner[k];
      const std::int32_t part = numbers.part(split.element, k);
      for (const std::int32_t i : corner) parts.push_back({i, part, &corner});
    }
  std::ranges::sort(parts, [](const NodePart& a, const NodePart& b) {
    return std::pair(a.node, a.element) < std::pair(b.node, b.element);
  });
  return parts;
}

// Whether facets with the node come once among all elements around it, as in find_surface_nodes.
static bool is_on_surface(std::span<const NodePart> around) {
  std::uint64_t sum = 0;
  for (const NodePart& part : around)
    for (std::size_t f = 0; f < 4; ++f)
      if ((*part.corner)[f] != part.node)
        sum ^= facet_key(*part.corner, facet_corners(ElementType::tet4, static_cast<int>(f)));
  return sum != 0;
}

// New stars go behind the others.
static void add_to_star(std::span<const NodePart> around, CutIndex& index) {
  std::vector<std::int32_t>& pool = index.star_element;
  const std::int32_t node = around.front().node;
  const auto begin = static_cast<std::int32_t>(pool.size());
  for (std::int32_t k = 0; k < index.star_size[node]; ++k)
    pool.push_back(pool[index.star_begin[node] + k]);
  for (const NodePart& part : around) pool.push_back(part.element);
  std::inplace_merge(pool.begin() + begin, pool.end() - std::ssize(around), pool.end());
  index.star_begin[node] = begin;
  index.star_size[node] = static_cast<std::int32_t>(pool.size()) - begin;
}

static void split_in_index(const Mesh& mesh, const MeshEdit& edit, CutIndex& index) {
  if (edit.splits.empty()) return;
  for (const ElementSplit& split : edit.splits) {
    forget_across(index, split.element);
    for (const std::int32_t i : mesh.corners(split.element))
      remove_from_star(index, i, split.element);
  }
  const std::vector<NodePart> parts =
      parts_at_nodes(edit, SplitNumbers(edit.splits, mesh.n_elements()));
  for (auto part = parts.begin(); part != parts.end();) {
    const auto end = std::ranges::find_if(part, parts.end(),
                                          [&](const NodePart& p) { return p.node != part->node; });
    const std::span<const NodePart> around(part, end);
    add_to_star(around, index);
    if (part->node >= mesh.n_nodes()) index.is_surface[part->node] = is_on_surface(around) ? 1 : 0;
    part = end;
  }
  index.n_elements += static_cast<std::size_t>(n_added(edit.splits));
  index.across.resize(index.n_elements, {not_known, not_known, not_known, not_known});
  index.local_element.resize(index.n_elements, -1);
  index.corner_node = nullptr;
}

std::vector<std::int32_t> elements_around(const CutIndex& index,
                                          std::span<const std::int32_t> node) {
  std::vector<std::int32_t> around;
  for (const std::int32_t i : node) {
    const std::span<const std::int32_t> star = index.star(i);
    around.insert(around.end(), star.begin(), star.end());
  }
  sort_unique(around);
  return around;
}

void edit_index(const Mesh& mesh, const MeshEdit& edit, CutIndex& index) {
  std::vector<CornerChange> change = edit.corners;
  std::stable_sort(change.begin(), change.end(), [](const CornerChange& a, const CornerChange& b) {
    return a.node != b.node ? a.node < b.node : a.element < b.element;
  });
  add_nodes(mesh.X.size() + edit.n_new_nodes(), index);
  split_in_index(mesh, edit, index);
  add_opened_facets(mesh, edit, index);
  for (const CornerChange& c : change) {
    const std::int32_t before = mesh.corners(c.element)[c.corner];
    forget_across(index, c.element);
    remove_from_star(index, before, c.element);
    if (index.star_size[c.node]++ == 0)
      index.star_begin[c.node] = static_cast<std::int32_t>(index.star_element.size());
    index.star_element.push_back(c.element);
  }
}

}  // namespace trocar
