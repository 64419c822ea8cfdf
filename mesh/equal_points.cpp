#include "mesh/equal_points.h"

#include <algorithm>
#include <numeric>

namespace trocar {

std::vector<std::int32_t> first_equal(std::span<const Vec3> X) {
  std::vector<std::int32_t> order(X.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    if (is_before(X[i], X[j])) return true;
    return !is_before(X[j], X[i]) && i < j;
  });
  std::vector<std::int32_t> first(X.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_same = k > 0 && !is_before(X[order[k - 1]], X[order[k]]);
    first[order[k]] = is_same ? first[order[k - 1]] : order[k];
  }
  return first;
}

}  // namespace trocar
