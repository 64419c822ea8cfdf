// Second rung where an opening goes wrong: chips. Where cuts meet, an opening may split off a piece
// of a few elements that the blade did not; it goes with the other side instead.
#pragma once

#include "cutting/cut_open.h"

namespace trocar {

struct CutChip {
  Vec3 centre = Vec3::Zero();         // reference configuration [m]
  std::vector<std::int32_t> element;  // local
};

// Gives the elements of pieces below half a mean edge cubed, which `opening` would free, the other
// side; returns the pieces.
std::vector<CutChip> attach_chips(const CutSurroundings& around, const CutOpening& opening,
                                  CutLabels& labels);

}  // namespace trocar
