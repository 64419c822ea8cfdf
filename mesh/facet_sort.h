// Facets and edges of all elements sorted by their nodes, so that equal ones stand side by side:
// what neighbours, surfaces, edges and the check for broken meshes are made of.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// One side of a facet. `node` ascending; -1 fills up in front, so that edge, triangle and quad
// differ.
struct FacetSide {
  std::array<std::int32_t, 4> node;
  std::int32_t element;
  std::int32_t facet;
  auto operator<=>(const FacetSide&) const = default;
};

// All sides: by lowest node, then by the others, then by element. Corner numbers must be in range.
std::vector<FacetSide> sorted_facet_sides(const Mesh& mesh);

// Corner pairs of the edges of an element.
std::span<const std::array<int, 2>> edge_corners(ElementType type);

}  // namespace trocar
