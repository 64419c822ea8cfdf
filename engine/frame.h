// One frame of a running scene. Read this first.
#pragma once

#include "engine/output.h"
#include "engine/simulation.h"

namespace trocar {

// Advances the simulation by one frame and writes what is due. Collective. Throws SimulationError
// if the physics can't be continued even with smaller steps: the state is then that of the last
// good frame, unless it was a cut that led to trouble.
void run_frame(Simulation& s, Outputs& outputs);

// A step of the tissue alone, to be timed: supports rest, nothing touches it. Collective.
void step_alone(Simulation& s, double dt);

}  // namespace trocar
