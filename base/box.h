// A box along the axes, empty at first.
#pragma once

#include <span>

#include "base/vec.h"

namespace trocar {

struct Box {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }
  Vec3 size() const { return high - low; }
  Vec3 middle() const { return 0.5 * (low + high); }
  bool overlaps(const Box& box, double margin = 0) const {
    return (low.array() <= box.high.array() + margin).all() &&
           (box.low.array() <= high.array() + margin).all();
  }
  bool holds(const Vec3& p, double margin) const { return overlaps({p, p}, margin); }
  Box grown(double margin) const { return {low.array() - margin, high.array() + margin}; }
  double distance2(const Vec3& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
  }
};

inline Box bounding_box(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.add(point);
  return box;
}

}  // namespace trocar
