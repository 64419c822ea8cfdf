#include "base/quantile.h"

#include <algorithm>
#include <cmath>

namespace trocar {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  // Nearest rank: the least value that at least q n of the n values do not exceed. q n may lie a
  // rounding error above a whole number.
  const auto rank =
      static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size()) - 1e-9));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

}  // namespace trocar
