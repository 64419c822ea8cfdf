#include "engine_motion.h"

#include <algorithm>
#include <cmath>

#include "larger_or_nan.h"

namespace trocar {

Vec3 momentum(const Simulation& s) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < s.mass.size(); ++i) sum += s.mass[i] * Vec3::Map(&s.state.v[3 * i]);
  return sum;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return HUGE_VAL;
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = larger_or_nan(most, std::abs(a[k] - b[k]));
  return most;
}

}  // namespace trocar
