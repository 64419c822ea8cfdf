// A triangle's normal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/vec.h"

namespace trocar {

using Triangle = std::array<Vec3, 3>;

// By the right-hand rule, twice as long as the area.
inline Vec3 area_normal(const Triangle& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]);
}

// Nothing for a triangle without area.
inline std::optional<Vec3> unit_normal(const Triangle& x) {
  const Vec3 area = area_normal(x);
  const double length2 = area.squaredNorm();
  const double edge2 = std::max((x[1] - x[0]).squaredNorm(), (x[2] - x[0]).squaredNorm());
  // Below a height of 1e-12 edges the direction is rounding.
  if (!(length2 > 1e-24 * edge2 * edge2)) return std::nullopt;
  return area / std::sqrt(length2);
}

}  // namespace trocar
