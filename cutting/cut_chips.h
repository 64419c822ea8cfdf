// Second rung where an opening goes wrong: chips. Where cuts meet, an opening may split off a piece
// of a few elements that the blade did not; it goes with the other side instead.
#pragma once

#include "cutting/cut_open.h"

namespace trocar {

// Gives the elements of pieces below half a mean edge cubed, which `opening` would free, the other
// side; returns the pieces' centres.
std::vector<Vec3> attach_chips(const CutSurroundings& around, const CutOpening& opening,
                               CutLabels& labels);

}  // namespace trocar
