// Each built-in problem against what is known of one-point hexahedra (numbers of a separate program
// with hourglass stiffness .1 or .2 instead of .15: hence bounds half as large again).
#include "study/study_problem.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/threads.h"

namespace trocar {
namespace {

const bool is_one_thread = (set_thread_count(1), true);

double relative_error(const Problem& problem, const char* method, int n,
                      Precision precision = Precision::in_double) {
  const Outcome outcome = problem.solve({method_named(method), precision, .9, n});
  EXPECT_EQ(outcome.trouble, "");
  EXPECT_GT(outcome.n_steps, 0);
  EXPECT_GT(outcome.stepping_seconds, 0);
  return std::abs(outcome.value / problem.reference - 1);
}

TEST(StudyProblem, indentation_by_8_hexahedra_is_within_1_percent_and_converges) {
  const Problem problem = problem_indentation();
  const double coarse = relative_error(problem, "hex8", 4),
               fine = relative_error(problem, "hex8", 8);
  EXPECT_LT(fine, 1.5 * .007);  // h = 6.25 mm: .7 %
  EXPECT_LT(fine, coarse / 1.8);
}

TEST(StudyProblem, the_bonded_cubes_force_on_4_hexahedra_is_within_one_and_a_half_percent) {
  const Problem problem = problem_bonded_cube();
  const double coarse = relative_error(problem, "hex8", 4);
  EXPECT_LT(coarse, 1.5 * .008);                                // 6.133 / 6.084: .8 %
  EXPECT_LT(relative_error(problem, "hex8", 8), coarse / 1.8);  // order 1.36: 2.6
}

TEST(StudyProblem, lame_modes_period_on_8_hexahedra_is_within_4_percent_and_converges) {
  const Problem problem = problem_lame_mode();
  const double coarse = relative_error(problem, "hex8", 8);
  EXPECT_LT(coarse, 1.5 * .026);
  EXPECT_LT(relative_error(problem, "hex8", 16), coarse / 3);  // 2.6 % and .5 %
}

TEST(StudyProblem, bending_columns_peak_converges_to_the_reference_with_second_order) {
  // A quarter each time the cells are halved, while the error (.9 %, .2 %) is far above the
  // reference's own (.03 %).
  const Problem problem = problem_bending_column();
  const double coarse = relative_error(problem, "hex8", 4),
               fine = relative_error(problem, "hex8", 8);
  EXPECT_LT(coarse, .012);
  EXPECT_NEAR(coarse / fine, 4, 1);
}

TEST(StudyProblem, bodies_that_fill_no_whole_block_of_lanes_relax_too) {
  // 27 hexahedra: blocks hold 8 in double and 16 in single precision.
  EXPECT_LT(relative_error(problem_indentation(), "hex8", 3), .2);
  EXPECT_LT(relative_error(problem_indentation(), "hex8", 3, Precision::in_single), .2);
}

TEST(StudyProblem, plain_tetrahedra_lock_and_gain_by_refinement) {
  // The same separate program: +41 % at h = 6.25 mm.
  const Problem problem = problem_indentation();
  const double coarse = relative_error(problem, "tet4", 4),
               fine = relative_error(problem, "tet4", 8);
  EXPECT_GT(fine, .2);
  EXPECT_LT(fine, coarse);
}

TEST(StudyProblem, single_precision_gives_the_same_result_to_a_ten_thousandth) {
  // Rounding of 6e-8 in strains, times the ratio of bulk to shear modulus (50): 3e-6.
  for (const Problem& problem : built_in_problems()) {
    const Case c{method_named("hex8"), Precision::in_double, .9, 4};
    Case in_single = c;
    in_single.precision = Precision::in_single;
    EXPECT_NEAR(problem.solve(in_single).value / problem.solve(c).value, 1, 1e-4) << problem.name;
  }
}

}  // namespace
}  // namespace trocar
