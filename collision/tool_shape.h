// The shape of an instrument for contact: convex pieces in the instrument's frame.
#pragma once

#include <vector>

#include "base/vec.h"

namespace trocar {

// A sphere (one point), a capsule (two points) or the convex hull of points, each thickened by
// `radius`. [m]
// Hulls of more than 64 points are reduced when the detector is built.
struct ConvexPiece {
  std::vector<Vec3> points;
  double radius = 0;
};

struct ToolShape {
  std::vector<ConvexPiece> pieces;
};

}  // namespace trocar
