// Distance and penetration of a convex hull and a triangle by Bullet's GJK and EPA in double
// precision. The only file pair that sees Bullet; no state outlives a call, so the same input
// gives the same bits whatever was asked before.
#pragma once

#include <memory>
#include <vector>

#include "collision/closest_point.h"

namespace trocar {

// distance < 0: they intersect, and the triangle leaves the hull when it moves by -distance along
// the normal.
struct HullPair {
  Vec3 on_hull = Vec3::Zero();
  TrianglePoint on_triangle;
  Vec3 normal = Vec3::Zero();  // from hull to triangle, unit
  double distance = 0;
};

class HullShape {
 public:
  // At least three points; flat hulls are allowed.
  explicit HullShape(const std::vector<Vec3>& points);
  ~HullShape();
  HullShape(HullShape&&) noexcept;
  HullShape& operator=(HullShape&&) noexcept;

  // Nothing where Bullet finds no answer that can be proven right: about 1 pair in 40,000, and flat
  // hulls that intersect a coplanar triangle.
  std::optional<HullPair> closest(const Triangle& triangle) const;

 private:
  struct Bullet;
  std::unique_ptr<Bullet> bullet_;
};

}  // namespace trocar
