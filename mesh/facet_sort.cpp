// Around one node after the other, so that a million hexahedra take 36 MB: all sides at once 340.
#include "mesh/facet_sort.h"

#include <algorithm>
#include <limits>

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

static std::int32_t lowest_node(const Mesh& mesh, std::int32_t e, int f) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
  for (const int corner : facet_corners(mesh.element_type[e], f))
    if (corner >= 0) lowest = std::min(lowest, node[static_cast<std::size_t>(corner)]);
  return lowest;
}

void for_each_facet(const Mesh& mesh,
                    const std::function<void(std::span<const FacetSide>)>& visit) {
  const NodeElements around = node_elements(mesh);
  std::vector<FacetSide> side;  // of the facets whose lowest node is i
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    side.clear();
    for (const std::int32_t e : around.of(i))
      for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
        if (lowest_node(mesh, e, f) == i) side.push_back(facet_side(mesh, e, f));
    std::sort(side.begin(), side.end());
    for (auto begin = side.begin(), end = begin; begin != side.end(); begin = end) {
      end = std::find_if(begin, side.end(),
                         [&](const FacetSide& s) { return s.node != begin->node; });
      visit({begin, end});
    }
  }
}

std::vector<FacetSide> single_sides(const Mesh& mesh) {
  std::vector<FacetSide> single;
  for_each_facet(mesh, [&](std::span<const FacetSide> side) {
    if (side.size() == 1) single.push_back(side[0]);
  });
  return single;
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
