// Fewer points for a convex hull: the ones that span it most. And its faces.
#pragma once

#include <vector>

#include "base/vec.h"

namespace trocar {

inline constexpr std::size_t max_hull_points = 64;

// The points that are extreme in one of 728 directions, in their order; of those, when there are
// more than 64, the extremes of the 26 main directions and then always the one farthest from all
// chosen so far.
std::vector<Vec3> reduce_hull(const std::vector<Vec3>& points);

// Outward unit normals n and offsets d, n·x <= d inside: the planes through three points with all
// others on one side (no more than 64 points: some million products at most). A flat hull has two.
struct HullFaces {
  std::vector<Vec3> normal;
  std::vector<double> offset;
};
HullFaces hull_faces(const std::vector<Vec3>& points);

}  // namespace trocar
