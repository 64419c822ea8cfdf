#include "mesh/element_shape.h"

namespace trocar {

int n_facets(ElementType type) {
  constexpr std::array<int, n_element_types> n = {3, 4, 6};
  return n[static_cast<std::size_t>(type)];
}

std::array<int, 4> facet_corners(ElementType type, int f) {
  using Corners = std::array<int, 4>;
  constexpr auto of_tet = [](int k) {
    return Corners{tet_facets[k][0], tet_facets[k][1], tet_facets[k][2], -1};
  };
  static constexpr std::array<std::array<Corners, 6>, n_element_types> corners = {{
      {{{1, 2, -1, -1}, {2, 0, -1, -1}, {0, 1, -1, -1}}},
      {{of_tet(0), of_tet(1), of_tet(2), of_tet(3)}},
      {{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
  }};
  return corners[static_cast<std::size_t>(type)][f];
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
