// The deformed body after a plane cut: what is valid in the reference may be inverted there.
#pragma once

#include "cutting/cut_plane_patch.h"

namespace trocar {

// Present area over reference area after the cut, over the least around before it: below this an
// element is as good as inverted, as for tetrahedra.
inline constexpr double least_present_ratio = 0.2;

// The element that has least of it.
struct Crushed {
  double ratio = 1;
  Vec2 centre = Vec2::Zero();  // reference configuration [m]
};

// Halves the moves of nodes beside the cut around elements that have less than
// least_present_ratio of it, again and again; the reference has to be looked at anew. What then has
// least of it. `before` is the patch as it was cut out of the mesh; elements that the cut leaves as
// they are don't count.
Crushed pull_back(const PlanePatch& before, std::span<const std::uint8_t> is_cut,
                  PlanePatch& after);

}  // namespace trocar
