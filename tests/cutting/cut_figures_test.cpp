#include "cutting/cut_figures.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(CutFigures, of_steps_add_up_and_deviations_count_by_their_nodes) {
  CutFigures sum;
  add({.n_opened_facets = 2,
       .n_moved = 10,
       .n_refused = 1,
       .least_quality = 0.7,
       .largest_deviation = 0.3,
       .deviation_sum = 0.3,
       .n_on_cut = 1,
       .refusals = {{Vec3(1, 0, 0), CutRefusal::chip}},
       .mean_edge = 4},
      true, sum);
  add({.goes_through = true,
       .n_opened_facets = 5,
       .n_refused = 1,
       .least_quality = 0.8,
       .largest_deviation = 0.2,
       .deviation_sum = 3 * 0.1,
       .n_on_cut = 3,
       .refusals = {{Vec3(2, 0, 0), CutRefusal::held}},
       .mean_edge = 5},
      true, sum);
  EXPECT_TRUE(sum.goes_through);
  EXPECT_EQ(sum.n_opened_facets, 7);
  EXPECT_EQ(sum.n_moved, 10);
  EXPECT_EQ(sum.n_refused, 2);
  ASSERT_EQ(sum.refusals.size(), 2u);
  EXPECT_EQ(sum.refusals[1].reason, CutRefusal::held);
  EXPECT_EQ(sum.least_quality, 0.7);
  EXPECT_EQ(sum.largest_deviation, 0.3);
  EXPECT_DOUBLE_EQ(sum.mean_deviation(), (0.3 + 3 * 0.1) / 4);
  EXPECT_EQ(sum.mean_edge, 5);
}

TEST(CutFigures, of_a_step_without_an_edit_are_what_its_blade_met) {
  CutFigures sum;
  EXPECT_EQ(sum.mean_deviation(), 0);
  sum = {.n_opened_facets = 3, .n_moved = 2, .deviation_sum = 0.1, .n_on_cut = 1, .mean_edge = 4};
  add({.is_in_slit = true,
       .n_opened_facets = 9,
       .n_moved = 9,
       .n_refused = 1,
       .deviation_sum = 9,
       .n_on_cut = 9,
       .n_beside = 2,
       .refusals = {{}},
       .mean_edge = 9},
      false, sum);
  EXPECT_TRUE(sum.is_in_slit);
  EXPECT_EQ(sum.n_refused, 1);
  EXPECT_EQ(sum.n_beside, 2);
  EXPECT_EQ(sum.n_opened_facets, 3);
  EXPECT_EQ(sum.n_moved, 2);
  EXPECT_EQ(sum.mean_deviation(), 0.1);
  EXPECT_EQ(sum.mean_edge, 4);
}

}  // namespace
}  // namespace trocar
