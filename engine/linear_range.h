// Where linear materials leave the range of small displacement gradients, for which they are.
//
// Of nearly incompressible tissue in uniaxial compression by e, with stretch L = 1 - e, the linear
// law gives a force of 3 mu e and the neo-Hookean one mu (1/L^2 - L), 1 + e + O(e^2) times as much:
// linear elasticity misses a tenth of it at e = 0.097, less with a smaller Poisson's ratio.
// Rotations by an angle t strain linear material by 1 - cos t; their displacement gradient has the
// norm 2 sin(t / 2), which reaches 0.1 at 5.7 degrees.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Norm of the displacement gradient, the largest change of any line element over its length.
inline constexpr double linear_range = 0.1;

// Warns, once a run, where an element of linear material is beyond this range at the end of a
// frame; looks at every tenth one. Collective.
void watch_linear_range(Simulation& s, double time);

}  // namespace trocar
