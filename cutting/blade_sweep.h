// The surface that a blade's edge sweeps between two moments, in the present configuration.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"

namespace trocar {

// Edge points before and after (same count, >= 2) make a band of quads, each split into two
// triangles (a0 b0 b1), (a0 b1 a1). [m] normal: the blade's flat side, tells + from - ; the band is
// turned so that it agrees.
struct BladeSweep {
  std::vector<Vec3> before;
  std::vector<Vec3> after;
  Vec3 normal = Vec3::UnitZ();
  // Of the tissue that each point comes nearest to, between the two moments; none: at rest. [m]
  std::vector<Vec3> tissue_way = {};
};

}  // namespace trocar
