#include "verification_clamped_edge.h"

#include <cmath>

namespace trocar {

double order_at_clamped_edge(double nu) {
  const double k = 3 - 4 * nu;
  double low = .5, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double lambda = (low + high) / 2, sine = std::sin(lambda * std::acos(0.0));
    (sine * sine < ((k + 1) * (k + 1) / 4 - lambda * lambda) / k ? low : high) = lambda;
  }
  return 2 * low;
}

}  // namespace trocar
