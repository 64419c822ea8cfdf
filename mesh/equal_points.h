// Points at the same place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace trocar {

// (X.size()) For each point the first one with equal coordinates.
std::vector<std::int32_t> first_equal(std::span<const Vec3> X);

}  // namespace trocar
