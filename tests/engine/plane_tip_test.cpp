#include "engine/plane_tip.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(PlaneTip, is_where_the_edge_goes_through_the_plane) {
  const std::vector<Vec3> edge = {{1, 2, -3}, {1.5, 2, -2}, {3, 2, 1}};  // straight
  EXPECT_LT((tip_in_plane(edge, 0) - Vec3(2.5, 2, 0)).norm(), 1e-15);
}

TEST(PlaneTip, is_the_nearer_end_of_an_edge_beside_the_plane_and_in_it_within_the_body) {
  const std::vector<Vec3> above = {{1, 2, 3}, {1, 2, 9}}, below = {{1, 2, -9}, {1, 4, -3}};
  EXPECT_EQ(tip_in_plane(above, 6), Vec3(1, 2, 0));
  EXPECT_EQ(tip_in_plane(above, 5.9), Vec3(1, 2, 3));
  EXPECT_EQ(tip_in_plane(below, 6), Vec3(1, 4, 0));
  EXPECT_EQ(tip_in_plane(below, 5.9), Vec3(1, 4, -3));
}

TEST(PlaneTip, goes_from_where_the_tissue_has_taken_its_begin_in_steps_no_longer_than_asked) {
  BladeSweep sweep{{{0, 0, 0}}, {{3, 0, 0}}};
  EXPECT_EQ(first_tip(sweep), Vec3(0, 0, 0));
  EXPECT_EQ(way_of_tip(sweep, 1.1).size(), 4U);  // three steps
  sweep.tissue_way = {{3, 4, 0}};
  EXPECT_EQ(first_tip(sweep), Vec3(3, 4, 0));
  const std::vector<Vec3> way = way_of_tip(sweep, 1.1);
  ASSERT_EQ(way.size(), 5U);
  EXPECT_EQ(way.front(), Vec3(3, 0, 0));
  EXPECT_EQ(way.back(), Vec3(3, 4, 0));
}

}  // namespace
}  // namespace trocar
