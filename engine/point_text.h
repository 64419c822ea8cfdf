// A point as messages tell it.
#pragma once

#include <string>

#include "base/number_text.h"
#include "base/vec.h"

namespace trocar {

// "(0.1, 0, 0.02)", three digits each.
inline std::string point_text(const Vec3& x) {
  return "(" + short_text(x.x()) + ", " + short_text(x.y()) + ", " + short_text(x.z()) + ")";
}

}  // namespace trocar
