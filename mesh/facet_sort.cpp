// A counting sort by the lowest node leaves runs of some twenty facets, each sorted on its own: 20
// ms for 100,000 tetrahedra. Comparing packed 64-bit words instead of arrays took off a tenth only.
#include "mesh/facet_sort.h"

#include <algorithm>

#include "mesh/facets.h"

namespace trocar {

static FacetSide facet_side(const Mesh& mesh, std::int32_t e, int f) {
  const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
  const std::span<const std::int32_t> node = mesh.corners(e);
  FacetSide side{{-1, -1, -1, -1}, e, f};
  for (std::size_t a = 0; a < 4 && corner[a] >= 0; ++a)
    side.node[a] = node[static_cast<std::size_t>(corner[a])];
  std::sort(side.node.begin(), side.node.end());
  return side;
}

static std::size_t lowest_node(const FacetSide& side) {
  for (const std::int32_t i : side.node)
    if (i >= 0) return static_cast<std::size_t>(i);
  return 0;
}

std::vector<FacetSide> sorted_facet_sides(const Mesh& mesh) {
  std::vector<FacetSide> unsorted;
  unsorted.reserve(mesh.corner_node.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
      unsorted.push_back(facet_side(mesh, e, f));

  std::vector<std::size_t> end(mesh.X.size() + 1, 0);  // first the start, then the end of each run
  for (const FacetSide& side : unsorted) ++end[lowest_node(side) + 1];
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<FacetSide> sorted(unsorted.size());
  for (const FacetSide& side : unsorted) sorted[end[lowest_node(side)]++] = side;

  std::size_t begin = 0;
  for (std::size_t i = 0; i < mesh.X.size(); begin = end[i++])
    std::sort(&sorted[0] + begin, &sorted[0] + end[i]);
  return sorted;
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
