// The shape of an instrument for contact: convex pieces in the instrument's frame.
#pragma once

#include <limits>
#include <vector>

#include "base/vec.h"

namespace trocar {

// A sphere (one point), a capsule (two points) or the convex hull of points, each thickened by
// `radius`. [m]
// Hulls of more than 64 points are reduced when the detector is built.
struct ConvexPiece {
  std::vector<Vec3> points;
  double radius = 0;
  // Of a blade, which touches with its flat sides (its edge and tip cut): least |y| of a contact's
  // normal, and the depth from which on tissue is not cut yet and passes through. [-], [m]
  double least_flatness = 0;
  double deepest = std::numeric_limits<double>::infinity();
  // Its edge looks along +x and cuts what lies before it. (Scissors cut only as they close.)
  bool has_edge = false;
};

struct ToolShape {
  std::vector<ConvexPiece> pieces;
};

}  // namespace trocar
