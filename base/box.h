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

// Along axes of its own (columns).
struct OrientedBox {
  Mat3 axes = Mat3::Identity();
  Vec3 low, high;

  // Its box along the axes of space.
  Box around() const {
    const Vec3 middle = axes * (0.5 * (low + high));
    const Vec3 reach = axes.cwiseAbs() * (0.5 * (high - low));
    return {middle - reach, middle + reach};
  }
  // False where one of its axes, or of space, parts them by more than `margin`, and rounding.
  bool may_overlap(const Box& box, double margin) const {
    const Vec3 middle = axes.transpose() * box.middle();
    const Vec3 half = 0.5 * box.size().array() + margin;
    const Vec3 reach =
        (1 + 1e-12) * (axes.cwiseAbs().transpose() * half) + 1e-14 * middle.cwiseAbs();
    return (middle + reach - low).minCoeff() >= 0 && (high - middle + reach).minCoeff() >= 0 &&
           around().overlaps(box, margin);
  }
};

inline Box bounding_box(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.add(point);
  return box;
}

}  // namespace trocar
