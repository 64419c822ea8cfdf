#include "study/study_sweep.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/error.h"

namespace trocar {
namespace {

// Value 1 + n^-2 after n^3 elements and n steps of a microsecond each.
Outcome solve_made_up(const Case& c) {
  const double n = c.n;
  return {.value = 1 + 1 / (n * n),
          .h = 1 / n,
          .n_elements = c.n * c.n * c.n,
          .n_steps = c.n,
          .stepping_seconds = 1e-6 * n * n * n * n};
}

Problem made_up_problem(double reference_error) {
  return {.name = "made-up",
          .title = "Made up",
          .quantity = "value",
          .unit = "1",
          .reference = 1,
          .reference_error = reference_error,
          .source = "closed form",
          .sizes = {4, 2, 8},
          .methods = solid_methods(),
          .factors = {1},
          .solve = solve_made_up};
}

TEST(StudySweep, it_runs_every_size_element_and_precision_coarse_ones_first) {
  const Study study = sweep(made_up_problem(0), {});
  ASSERT_EQ(study.runs.size(), 3 * 2 * solid_methods().size());
  for (std::size_t k = 1; k < study.runs.size(); ++k)
    EXPECT_GE(study.runs[k].n, study.runs[k - 1].n);
  for (const auto& run : study.runs) EXPECT_NEAR(run.error, 1. / (run.n * run.n), 1e-15);
}

TEST(StudySweep, of_repeated_runs_the_median_and_the_least_time_are_kept) {
  Problem problem = made_up_problem(0);
  int k = 0;
  problem.solve = [&](const Case& c) {
    Outcome outcome = solve_made_up(c);
    outcome.stepping_seconds = 1e-3 * std::array{5, 2, 9}[k++ % 3];
    return outcome;
  };
  const Study study =
      sweep(problem, {.sizes = {2}, .elements = {"hex8"}, .precisions = {"double"}});
  ASSERT_EQ(study.runs.size(), 1U);
  EXPECT_EQ(study.runs[0].outcome.stepping_seconds, 5e-3);
  EXPECT_EQ(study.runs[0].outcome.least_stepping_seconds, 2e-3);
}

TEST(StudySweep, a_size_that_can_not_be_built_leaves_the_others) {
  Problem problem = made_up_problem(0);
  problem.solve = [](const Case& c) {
    if (c.n == 8) throw InputError("too many nodes");
    return solve_made_up(c);
  };
  const SweepOptions one = {.elements = {"hex8"}, .precisions = {"double"}};
  const Study study = sweep(problem, one);
  ASSERT_EQ(study.runs.size(), 3U);
  EXPECT_EQ(study.runs[2].outcome.trouble, "too many nodes");
  EXPECT_TRUE(is_sound(study.runs[1]));
  SweepOptions only = one;
  only.sizes = {8};
  EXPECT_THROW(sweep(problem, only), InputError);
}

// Not of the duration that was asked for: whole frames are run, and the tenth period may end early.
TEST(StudySweep, costs_are_those_of_the_time_that_was_simulated) {
  Study study{.problem = made_up_problem(0)};
  study.problem.simulated_seconds = 1;
  study.runs.emplace_back().outcome = {.dt = 1e-3, .n_steps = 800, .stepping_seconds = 4};
  EXPECT_DOUBLE_EQ(cost_of(study, study.runs[0]), 5);
}

TEST(StudySweep, no_error_is_said_to_be_below_the_references_own) {
  const Study study = sweep(made_up_problem(.05), {});
  EXPECT_FALSE(study.runs.empty());
  for (const auto& run : study.runs) {
    EXPECT_EQ(run.is_at_reference, run.n == 8);  // 1/64 < .05 < 1/16
    EXPECT_GE(run.error, .05);
  }
}

TEST(StudySweep, sizes_that_the_budget_does_not_hold_are_left_out_and_named) {
  // n = 4096 is predicted to take (4096 / 2)^4 times the 16 microseconds of n = 2.
  const Study study =
      sweep(made_up_problem(0),
            {.sizes = {2, 4096}, .elements = {"hex8"}, .precisions = {"double"}, .budget = 5});
  ASSERT_EQ(study.runs.size(), 1u);
  EXPECT_EQ(study.runs[0].n, 2);
  ASSERT_EQ(study.notes.size(), 1u);
  EXPECT_NE(study.notes[0].find("hex8 double, n = 4096 left out"), std::string::npos)
      << study.notes[0];
}

TEST(StudySweep, notes_of_what_is_left_out_name_the_run_as_tables_do) {
  Problem problem = made_up_problem(0);
  problem.simulated_seconds = 1;
  problem.sleeps = {0, 1e-4};
  problem.size_label = [](int n) { return "box" + std::to_string(n); };
  const Study study = sweep(problem, {.sizes = {2, 4096},
                                      .elements = {"hex8"},
                                      .precisions = {"double"},
                                      .step_factors = {.5, 1},
                                      .budget = 5});
  ASSERT_EQ(study.notes.size(), 4U);
  const char* const names[] = {"hex8 double, step factor 0.5, box4096 left out",
                               "hex8 double, step factor 0.5, sleep 0.1 mm, box4096 left out",
                               "hex8 double, step factor 1, box4096 left out",
                               "hex8 double, step factor 1, sleep 0.1 mm, box4096 left out"};
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_TRUE(study.notes[k].starts_with(names[k])) << study.notes[k];
}

TEST(StudySweep, the_budget_of_mesh_files_goes_by_their_edges_and_not_by_their_numbers) {
  // By the numbers 2 would take 2^4 times the microsecond of 1, by the edges 1e12 times.
  Problem problem = made_up_problem(0);
  problem.edges = {.1, .1e-3};
  const Study study = sweep(
      problem, {.sizes = {1, 2}, .elements = {"hex8"}, .precisions = {"double"}, .budget = 5});
  ASSERT_EQ(study.runs.size(), 1U);
  EXPECT_EQ(study.runs[0].n, 1);
}

TEST(StudySweep, sizes_that_the_problem_can_not_have_are_refused) {
  Problem problem = made_up_problem(0);
  problem.size_multiple = 2;
  EXPECT_THROW(sweep(problem, {.sizes = {4, 3}}), InputError);
}

TEST(StudySweep, elements_and_precisions_that_do_not_exist_are_refused) {
  EXPECT_THROW(sweep(made_up_problem(0), {.elements = {"hex9"}}), InputError);
  EXPECT_THROW(sweep(made_up_problem(0), {.elements = {"tri3"}}), InputError);
  EXPECT_THROW(sweep(made_up_problem(0), {.precisions = {"half"}}), InputError);
}

// As a scene: displacements (1 + h, 0, 0) of one point, first order.
TEST(StudySweep, a_scenes_reference_is_its_finest_run_with_the_error_that_refinement_shows) {
  Problem problem = made_up_problem(0);
  problem.is_scene = true;
  problem.solve = [](const Case& c) {
    Outcome outcome = solve_made_up(c);
    outcome.samples = {Vec3(1 + outcome.h, 0, 0)};
    return outcome;
  };
  const Study study = sweep(problem, {.elements = {"hex8"}, .precisions = {"double"}});
  ASSERT_EQ(study.runs.size(), 3u);
  EXPECT_TRUE(study.runs[2].is_reference);
  EXPECT_DOUBLE_EQ(study.problem.length, 1.125);
  // h = 1/8: for a first-order method exactly what is left, 1/8 of 1.125.
  EXPECT_NEAR(study.problem.reference_error, .125 / 1.125, 1e-14);
  EXPECT_NEAR(study.runs[0].error_length, .5 - .125, 1e-14);
  EXPECT_NEAR(study.runs[1].error_length, .25 - .125, 1e-14);
}

TEST(StudySweep, a_scene_in_which_nothing_moves_is_refused) {
  Problem problem = made_up_problem(0);
  problem.is_scene = true;
  problem.solve = [](const Case& c) {
    Outcome outcome = solve_made_up(c);
    outcome.samples = {Vec3::Zero()};
    return outcome;
  };
  EXPECT_THROW(sweep(problem, {}), InputError);
}

TEST(StudySweep, the_reference_of_a_scene_is_not_the_method_that_is_still_moving) {
  Problem problem = made_up_problem(0);
  problem.is_scene = true;
  problem.solve = [](const Case& c) {
    Outcome outcome = solve_made_up(c);
    const bool is_slow = std::string(c.method.name) == "tet4";
    outcome.samples = {Vec3(1 - (is_slow ? 3 : 1) * outcome.h, 0, 0)};
    return outcome;
  };
  const Study study = sweep(problem, {.precisions = {"double"}});
  EXPECT_FALSE(study.runs.empty());
  for (const auto& run : study.runs)
    EXPECT_EQ(run.is_reference, run.method == "hex8" && run.n == 8);
}

TEST(StudySweep, broken_runs_have_no_error) {
  Problem problem = made_up_problem(0);
  problem.solve = [](const Case& c) {
    Outcome outcome = solve_made_up(c);
    if (c.n == 4) outcome.trouble = "inverted";
    return outcome;
  };
  const Study study = sweep(problem, {});
  EXPECT_FALSE(study.runs.empty());
  for (const auto& run : study.runs) EXPECT_EQ(std::isfinite(run.error), run.n != 4);
}

}  // namespace
}  // namespace trocar
