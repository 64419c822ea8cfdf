#include "engine/quiet_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/vec.h"

namespace trocar {

void note_actions(std::span<const double> values, std::size_t n_frames, QuietRange& range) {
  range.recent.insert(range.recent.end(), values.begin(), values.end());
  const std::size_t n = std::min(range.recent.size(), n_frames * values.size());
  range.recent.erase(range.recent.begin(), range.recent.end() - static_cast<std::ptrdiff_t>(n));
}

void narrow_range(std::size_t n, double share, QuietRange& range) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (range.low.empty()) {
    range.low.assign(n, -infinity);
    range.high.assign(n, infinity);
  }
  for (std::size_t first = 0; first < n; first += 3) {
    Vec3 low = Vec3::Constant(infinity), high = -low;
    for (std::size_t k = first; k < range.recent.size(); k += n) {
      const auto vector = Vec3::Map(&range.recent[k]);
      low = low.cwiseMin(vector);
      high = high.cwiseMax(vector);
    }
    const double beyond = share * std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
    for (std::size_t j = 0; j < 3; ++j) {
      const auto axis = static_cast<Eigen::Index>(j);
      range.low[first + j] = std::max(range.low[first + j], low[axis] - beyond);
      range.high[first + j] = std::min(range.high[first + j], high[axis] + beyond);
    }
  }
}

bool leave_range(const QuietRange& range) {
  const std::span now = std::span(range.recent).last(range.low.size());
  for (std::size_t k = 0; k < now.size(); ++k)
    if (now[k] < range.low[k] || now[k] > range.high[k]) return true;
  return false;
}

}  // namespace trocar
