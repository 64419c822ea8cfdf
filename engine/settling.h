// How slowly a body comes to rest.
#pragma once

#include "engine/simulation.h"

namespace trocar {

inline constexpr double longest_settling = 3600;  // [s]
// Time in which the undeformed body's slowest motion swings from one side to the other or, where
// damping is more than that leaves it, has died down to a fifth; rather more than that. By the
// farthest way that a small even acceleration along any axis takes a node, which dynamic relaxation
// finds in some hundred to some thousand steps; longest_settling if it doesn't. Torsion is no such
// way. 0 if nothing supports or holds any piece; those that nothing does don't count. The same bits
// on any ranks and threads. Collective. [s]
double settling_time(Simulation& s);

}  // namespace trocar
