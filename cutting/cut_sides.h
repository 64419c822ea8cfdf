// What the crossed edges of a tetrahedron say: on which side its corners lie, and whether the blade
// has parted them already.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cutting/cut_stroke.h"
#include "cutting/cut_surroundings.h"

namespace trocar {

// uncut: no crossed edge. separated: without its crossed edges the corners fall into a + and a -
// group. front: crossed, but still joined.
enum class CutKind : std::uint8_t { uncut, front, separated };

struct ElementSides {
  CutKind kind = CutKind::uncut;
  std::array<std::int8_t, 4> corner{};  // +1, -1; 0: on the surface, or not known
  std::array<bool, 4> is_neutral{};     // on the surface
};

// For each element of the patch. Nodes on the swept surface take neither side: edges from there are
// crossed by rounding only. These are nodes of opened facets that were pulled onto it, and nodes
// near it that crossings put on both sides.
std::vector<ElementSides> element_sides(const CutSurroundings& around, const CutStroke& stroke);

}  // namespace trocar
