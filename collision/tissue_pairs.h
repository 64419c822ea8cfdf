// Where tissue may touch tissue: the lips of a wound, folds, pieces that were cut off.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/surface_tree.h"

namespace trocar {

// A node of the surface and a triangle that is not its own.
struct TissuePair {
  std::int32_t node = 0;
  std::array<std::int32_t, 3> corner{};
  // What the node's distance is lengthened by in a choice between triangles: little for one that
  // lies flat against the node's own, more for one that meets them at an angle. At the rim of a
  // wound a node of one lip lies on the other lip and on the side below it; only the lip holds it.
  // [m]
  double handicap = 0;
};

// All pairs that may meet (SurfaceTree::facing), in ascending (node, triangle), if the node is, at
// the tree's positions,
// - on the triangle's outer side, or
// - inside other tissue, and the triangle is a way out of it. The far side of a node's own thin
//   lobe is none: a point a little behind the node, as the triangle sees it, is outside.
// ahead: (n_nodes) where the tissue's velocities take it within the frame, valid at surface nodes
// [m]. reach: how much nearer it may come than that, and how deep it may lie in other tissue and
// still find out of it [m].
void find_tissue_pairs(const SurfaceTree& tree, std::span<const Vec3> ahead, double reach,
                       std::vector<TissuePair>& pairs);

struct TissueTouch {
  TrianglePoint nearest;
  Vec3 normal = Vec3::Zero();  // of the triangle, outward; zero without area
  double distance = 0;         // [m]
  double height = 0;           // over the triangle's plane, along the normal [m]
  bool is_below = false;       // behind the triangle, and within 63 degrees straight below it
};
TissueTouch touch_tissue(const Vec3& x, const Triangle& triangle);
// The same, where the nearest point is known.
TissueTouch touch_tissue(const Vec3& x, const Triangle& triangle, const TrianglePoint& nearest);

// Distances within rounding of each other.
bool are_equally_near(double a, double b);

// Is nearer, handicaps included; of triangles that share the nearest point, the one that is seen
// more steeply knows on which side the node is.
struct TissueCandidate {
  TissueTouch touch;
  double handicap = 0;
};
bool says_more(const TissueCandidate& candidate, const TissueCandidate& than);

}  // namespace trocar
