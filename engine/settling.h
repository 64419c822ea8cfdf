// How slowly a body comes to rest.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Time in which the undeformed body's slowest motion swings from one side to the other or, where
// damping is more than that leaves it, has died down to a fifth. By the Rayleigh quotient of what a
// small even acceleration does to it, which dynamic relaxation finds in some hundred steps; 0 if it
// finds nothing. Pieces that nothing supports or holds don't count. The same bits on any ranks and
// threads. Collective. [s]
double settling_time(Simulation& s);

}  // namespace trocar
