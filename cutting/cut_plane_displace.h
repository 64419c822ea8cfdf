// Cut nodes onto their cut points, and the second mesh error.
#pragma once

#include <span>
#include <vector>

#include "cutting/cut_plane_chain.h"
#include "cutting/cut_plane_smooth.h"

namespace trocar {

// Moves each cut node onto its cut point. Elements whose three nodes lie on the cut would collapse:
// their edge that is no chain edge is flipped. Where a node would invert others it goes part of the
// way and its neighbours make room. False if it does not get there.
bool displace_onto_cut(PlanePatch& patch, std::span<const CutChain> chains,
                       std::span<const Movable> neighbours,
                       const std::vector<std::uint8_t>& is_cut_node);

}  // namespace trocar
