// What instruments have done, and what they have not.
#pragma once

#include "engine/simulation.h"

namespace trocar {

void note_grasp(Simulation& s, double time, const GraspAct& act);
// At the end of a stroke: how much the blade left joined, and the first place with its reason.
void note_refusals(Simulation& s, const CutRecord& record);
// At the end of a run: strokes that have not ended, with what they leave joined, blades that have
// cut nothing, parts that hang by few elements, and probes that have touched nothing.
void note_tools_at_end(Simulation& s);

}  // namespace trocar
