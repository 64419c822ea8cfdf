// Repeatable random shapes and poses, and the optimality condition of closest points.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "collision/closest_point.h"

namespace trocar {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Vec3 in_box(double half);
  Vec3 direction();
  Quat rotation();
  Triangle triangle(double half);

 private:
  std::mt19937 engine_;
};

// p of convex hull(first) and q of convex hull(second) are nearest if and only if no vertex goes
// beyond the planes through p and q across d = q - p (convexity): exact, unlike sampling.
template <class First, class Second>
void expect_nearest(const Vec3& p, const First& first, const Vec3& q, const Second& second,
                    double tolerance) {
  const double distance = (q - p).norm();
  if (distance <= tolerance) return;
  const Vec3 d = (q - p) / distance;
  for (const Vec3& a : first) EXPECT_LE(d.dot(a - p), tolerance);
  for (const Vec3& b : second) EXPECT_GE(d.dot(b - q), -tolerance);
}

// Turns z to the direction; Eigen takes seconds to compile it.
Quat rotation_from_z(const Vec3& direction);

Vec3 at_weights(const Triangle& x, const std::array<double, 3>& w);

}  // namespace trocar
