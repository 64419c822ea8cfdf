#include "base/segment.h"

#include <gtest/gtest.h>

#include "base/vec.h"

namespace trocar {
namespace {

TEST(Segment, is_nearest_at_the_foot_of_the_perpendicular_or_at_an_end) {
  const Vec3 a(1, 0, 0), b(3, 0, 0);
  EXPECT_EQ(nearest_on_segment(a, b, Vec3(1.5, 7, -2)), Vec3(1.5, 0, 0));
  EXPECT_EQ(nearest_on_segment(a, b, Vec3(-4, 1, 0)), a);
  EXPECT_EQ(nearest_on_segment(a, b, Vec3(9, 1, 0)), b);
  EXPECT_EQ(share_on_line(a, Vec3(b - a), Vec3(9, 1, 0)), 4);
}

TEST(Segment, may_be_a_point) {
  const Vec2 a(1, 2);
  EXPECT_EQ(nearest_on_segment(a, a, Vec2(5, 5)), a);
}

}  // namespace
}  // namespace trocar
