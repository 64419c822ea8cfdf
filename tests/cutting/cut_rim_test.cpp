// Rims that a stroke has passed, of made-up crossings in a plane.
#include "cutting/cut_rim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace trocar {
namespace {

// Crossings wherever `is_swept` in the plane x = 0, 0.3 mean edges apart, and a rim along the line
// from (0, 0) to (0, 3).
CutStroke swept(const std::function<bool(double y, double z)>& is_swept) {
  CutStroke stroke;
  stroke.mean_edge = 1;
  for (double y = -2.95; y < 3; y += 0.3)
    for (double z = -1.95; z < 5; z += 0.3)
      if (is_swept(y, z))
        stroke.hit.push_back({.element = static_cast<std::int32_t>(stroke.hit.size()),
                              .X = {0, y, z},
                              .N = Vec3::UnitX()});
  for (double z = 0; z < 3.1; z += 0.2) stroke.rim.emplace_back(0, 0, z);
  return stroke;
}

std::size_t n_left(CutStroke stroke) {
  drop_covered_rim(stroke);
  return stroke.rim.size();
}

TEST(CutRim, stays_where_the_blade_was_on_one_side_only) {
  const CutStroke stroke = swept([](double y, double) { return y < 0; });
  EXPECT_EQ(n_left(stroke), stroke.rim.size());
  EXPECT_EQ(n_left(swept([](double, double) { return false; })), stroke.rim.size());
}

TEST(CutRim, is_none_where_the_blade_was_on_both_sides) {
  EXPECT_EQ(n_left(swept([](double, double) { return true; })), 0U);
}

// Along the lower half crossings lie on one side. What is less than an edge away may see those of
// the upper half.
TEST(CutRim, ends_where_the_blade_has_passed_it) {
  CutStroke stroke = swept([](double y, double z) { return y < 0 || z > 1.5; });
  drop_covered_rim(stroke);
  ASSERT_FALSE(stroke.rim.empty());
  const double highest = std::ranges::max(stroke.rim, {}, [](const Vec3& R) { return R.z(); }).z();
  EXPECT_GT(highest, 0.5);
  EXPECT_LT(highest, 1.7);
}

TEST(CutRim, stays_where_another_surface_lies_beside_it) {
  CutStroke stroke = swept([](double y, double) { return y < 0; });
  for (const CutHit& hit : CutStroke(stroke).hit) {
    stroke.hit.push_back(hit);
    stroke.hit.back().X = {0.5, -hit.X.y(), hit.X.z()};
  }
  const std::size_t n = stroke.rim.size();
  EXPECT_EQ(n_left(stroke), n);
}

}  // namespace
}  // namespace trocar
