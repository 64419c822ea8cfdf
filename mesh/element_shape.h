// Which corners make the facets (faces in 3D, edges in 2D) and the edges of an element.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace trocar {

// Local corners of facet f of an element, outward normal by the right-hand rule; -1 fills up.
// tet4: facet f is opposite to corner f. tri3: facet f is the edge opposite to corner f, {a, b}
// with the inside to its left. hex8: bottom, top, front, right, back, left.
std::array<int, 4> facet_corners(ElementType type, int f);
int n_facets(ElementType type);
inline constexpr std::array<std::array<int, 3>, 4> tet_facets{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// Bits of the facets f of a tetrahedron in another element that lie on facets of `mask` of that
// one: on facet_of(f), which is -1 inside.
template <class FacetOf>
std::uint8_t tet_facets_on(std::uint8_t mask, const FacetOf& facet_of) {
  unsigned facets = 0;
  for (int f = 0; f < 4 && mask != 0; ++f) {
    const int g = facet_of(f);
    if (g >= 0 && (mask >> g & 1) != 0) facets |= 1U << f;
  }
  return static_cast<std::uint8_t>(facets);
}

// Corner pairs of the edges of an element.
std::span<const std::array<int, 2>> edge_corners(ElementType type);

}  // namespace trocar
