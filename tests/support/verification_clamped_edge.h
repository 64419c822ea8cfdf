// How fast linear elements converge where the solution is not smooth: at a clamped edge.
#pragma once

#include <cmath>

namespace trocar {

// Order of energies, frequencies and mean displacements where a clamped face meets a free one at a
// right angle: 2 lambda of the singular displacement r^lambda there (Williams 1952, plane strain),
//   sin^2(lambda pi/2) = [ (k + 1)^2/4 - lambda^2 ] / k,  k = 3 - 4 nu.
inline double order_at_clamped_edge(double nu) {
  const double k = 3 - 4 * nu;
  double low = .5, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double lambda = (low + high) / 2, sine = std::sin(lambda * std::acos(0.0));
    (sine * sine < ((k + 1) * (k + 1) / 4 - lambda * lambda) / k ? low : high) = lambda;
  }
  return 2 * low;
}

}  // namespace trocar
