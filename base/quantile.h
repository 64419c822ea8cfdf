// The value below which a share of values lies.
#pragma once

#include <vector>

namespace trocar {

// Quantile q in [0, 1] of values (nearest rank); 0 if empty.
double quantile(std::vector<double> values, double q);

}  // namespace trocar
