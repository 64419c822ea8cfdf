// How fast linear elements converge where the solution is not smooth: at a clamped edge.
#pragma once

namespace trocar {

// Order of energies, frequencies and mean displacements where a clamped face meets a free one at a
// right angle: 2 lambda of the singular displacement r^lambda there (Williams 1952, plane strain),
//   sin^2(lambda pi/2) = [ (k + 1)^2/4 - lambda^2 ] / k,  k = 3 - 4 nu.
double order_at_clamped_edge(double nu);

}  // namespace trocar
