// A box along the axes, empty at first.
#pragma once

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
  bool overlaps(const Box& box, double margin = 0) const {
    return (low.array() <= box.high.array() + margin).all() &&
           (box.low.array() <= high.array() + margin).all();
  }
  bool holds(const Vec3& p, double margin) const { return overlaps({p, p}, margin); }
  double distance2(const Vec3& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
  }
};

}  // namespace trocar
