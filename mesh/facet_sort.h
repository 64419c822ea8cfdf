// Facets with the elements on their sides: what neighbours, surfaces and the check for broken
// meshes are made of.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
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

// Calls `visit` with the sides of one facet after the other: facets by lowest node, then by the
// others, sides by element. Corner numbers must be in range.
void for_each_facet(const Mesh& mesh, const std::function<void(std::span<const FacetSide>)>& visit);

// " 3 7 9" for messages, without -1.
std::string nodes_text(std::span<const std::int32_t> node);

// Of facets that one element has, in that order.
std::vector<FacetSide> single_sides(const Mesh& mesh);

}  // namespace trocar
