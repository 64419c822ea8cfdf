// Natural frequencies of a body at rest from its forces.
#pragma once

#include "solver_body.h"

namespace trocar {

// The `n` lowest [Hz], by subspace iteration on (A + s I)^-1 with twice as many vectors; the shift
// s = 1/s^2 makes free bodies' tangents regular.
std::vector<double> lowest_frequencies(Body& body, int n);

// The greatest eigenvalue of M^-1 K of a linear body, by Lanczos with full orthogonalisation: after
// 80 steps converged far below 1e-3.
double highest_omega2(Body& body);

}  // namespace trocar
