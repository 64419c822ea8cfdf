// The cut of a plane body along the way of a blade's tip.
#pragma once

#include "engine/cut_stage.h"

namespace trocar {

// Takes the tip's way in the frame into the stroke's path, and cuts along it reach by reach.
// Collective.
void cut_along_tip(Simulation& s, CutStage& stage, const BladeSweep& sweep, bool is_last);

}  // namespace trocar
