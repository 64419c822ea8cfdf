#include "base/triangle.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(Triangle, has_a_normal_by_the_right_hand_rule) {
  const Triangle x = {Vec3(1, 1, 1), Vec3(3, 1, 1), Vec3(1, 5, 1)};
  EXPECT_EQ(area_normal(x), Vec3(0, 0, 8));
  EXPECT_EQ(*unit_normal(x), Vec3(0, 0, 1));
}

TEST(Triangle, without_area_has_no_unit_normal) {
  EXPECT_FALSE(unit_normal({Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(3, 3, 3)}).has_value());
  EXPECT_FALSE(unit_normal({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)}).has_value());
}

}  // namespace
}  // namespace trocar
