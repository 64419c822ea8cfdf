#include "collision/tissue_pairs.h"

#include <algorithm>
#include <cmath>
#include <span>
namespace trocar {

namespace {

constexpr double flattest = 2;  // distance beside the normal / depth
constexpr double equal = 1e-9;  // of distances
// Where other tissue is looked for: in depths below the triangle, and in lengths of the node's own
// triangle from the node towards its middle, as a node at a rim lies on other tissue's surface.
constexpr double below = 1e-3, inward = 0.02;
// Ways out that count, in the length of the nearest: the node may slide from one to the next.
constexpr double next_exits = 1.25;

struct Candidate : TissueCandidate {
  std::int32_t node = 0, triangle = 0, own = 0;
};

// Is there other tissue behind the triangle where its node is?
bool is_inside(const SurfaceTree& tree, const Candidate& c, double depth) {
  const Vec3& x = tree.position(c.node);
  const Vec3 p = x - below * depth * c.touch.normal;
  if (tree.winding_number(p) > 0) return true;
  const Triangle own = tree.corners(c.own);
  return tree.winding_number(p + inward * ((own[0] + own[1] + own[2]) / 3 - x)) > 0;
}

// The longest way out that counts for a node; 0 for one that is not inside other tissue. Nearer
// tissue in front of it says that what it is behind is the far side of its own.
double longest_exit(const SurfaceTree& tree, std::span<const Candidate> of_node, double depth) {
  const Candidate* nearest = nullptr;
  for (const Candidate& c : of_node)
    if (!nearest || says_more(c, *nearest)) nearest = &c;
  if (!nearest || !nearest->touch.is_below || !is_inside(tree, *nearest, depth)) return 0;
  return next_exits * nearest->touch.distance;
}

}  // namespace

TissueTouch touch_tissue(const Vec3& x, const Triangle& triangle) {
  return touch_tissue(x, triangle, closest_point_triangle(x, triangle));
}

TissueTouch touch_tissue(const Vec3& x, const Triangle& triangle, const TrianglePoint& nearest) {
  TissueTouch touch{.nearest = nearest, .normal = unit_normal(triangle).value_or(Vec3::Zero())};
  const Vec3 d = x - touch.nearest.point;
  touch.distance = d.norm();
  touch.height = touch.normal.dot(d);
  const double beside = (d - touch.height * touch.normal).norm();
  touch.is_below = touch.height < 0 && beside <= -flattest * touch.height;
  return touch;
}

bool are_equally_near(double a, double b) {
  return std::abs(a - b) <= equal * std::max(a, b);
}

bool says_more(const TissueCandidate& candidate, const TissueCandidate& than) {
  const double near = candidate.touch.distance, far = than.touch.distance;
  if (are_equally_near(near, far))
    return std::abs(candidate.touch.height) > std::abs(than.touch.height);
  return near + candidate.handicap < far + than.handicap;
}

void find_tissue_pairs(const SurfaceTree& tree, std::span<const Vec3> ahead, double reach,
                       std::vector<TissuePair>& pairs) {
  pairs.clear();
  const std::vector<SurfaceTree::Facing> facing = tree.facing(ahead, reach, reach);
  std::vector<Candidate> of_node;
  for (std::size_t k = 0; k < facing.size();) {
    const std::int32_t node = facing[k].node;
    of_node.clear();
    for (; k < facing.size() && facing[k].node == node; ++k) {
      const std::int32_t t = facing[k].triangle;
      of_node.push_back(
          {{touch_tissue(tree.position(node), tree.corners(t)), reach * (1 + facing[k].opposition)},
           node,
           t,
           facing[k].own});
    }
    const double longest = longest_exit(tree, of_node, reach);
    for (const Candidate& c : of_node)
      if (c.touch.height >= 0 || (c.touch.is_below && c.touch.distance <= longest))
        pairs.push_back({node, tree.nodes(c.triangle), c.handicap});
  }
}

}  // namespace trocar
