// One frame of a running scene. Read this first.
#pragma once

#include "engine/output.h"
#include "engine/simulation.h"

namespace trocar {

// Advances the simulation by one frame and writes what is due. Collective. Throws SimulationError
// if the physics can't be continued even with smaller steps: the state is then that of the last
// good frame, unless it was a cut that led to trouble.
void run_frame(Simulation& s, Outputs& outputs);

}  // namespace trocar
