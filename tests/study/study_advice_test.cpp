#include "study/study_advice.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "study_made_up.h"

namespace trocar {
namespace {

TEST(StudyAdvice, the_cheapest_run_within_the_target_is_taken_and_then_another_method) {
  // Within 1 %: slow at 8 (25 s) and quick at 8 (2.5 s). Within 5 %: quick at 4 for 0.16 s.
  const Study study = made_up_study();
  const auto* best = cheapest_within(study, {.error = .01});
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best, &study.runs[5]);
  EXPECT_EQ(cheapest_within(study, {.error = .01}, method_text(*best)), &study.runs[2]);
  EXPECT_EQ(cheapest_within(study, {.error = .05}), &study.runs[4]);
  EXPECT_EQ(cheapest_within(study, {.error = .001}), nullptr);
}

TEST(StudyAdvice, of_runs_that_cost_the_same_the_most_accurate_is_taken) {
  Study study = made_up_study();
  study.runs[4].error = .03;
  study.runs[1].error = .02;
  study.runs[1].outcome.stepping_seconds = 1.04 * study.runs[4].outcome.stepping_seconds;
  EXPECT_EQ(cheapest_within(study, {.error = .05}), &study.runs[1]);
  study.runs[1].outcome.stepping_seconds = 1.06 * study.runs[4].outcome.stepping_seconds;
  EXPECT_EQ(cheapest_within(study, {.error = .05}), &study.runs[4]);
}

TEST(StudyAdvice, of_runs_that_are_as_fast_and_as_accurate_the_cheapest_is_taken) {
  Study study = made_up_study();
  study.runs[1].error = .0299;  // 0.3 % less than the other
  study.runs[1].outcome.stepping_seconds = 1.04 * study.runs[4].outcome.stepping_seconds;
  study.runs[4].error = .03;
  EXPECT_EQ(cheapest_within(study, {.error = .05}), &study.runs[4]);
}

TEST(StudyAdvice, the_sentence_names_run_step_error_cost_and_the_next_best) {
  EXPECT_EQ(advice(made_up_study(), read_target("10 mm")),
            "For 10 mm error at least cost use quick double, step factor 0.9, n = 8 (h = 125 mm, "
            "dt = 1 ms): 8 mm for 2.5 s of processor time a simulated second; next best is slow "
            "double, step factor 0.9, n = 8 (h = 125 mm, dt = 1 ms): 5 mm for 25 s of processor "
            "time a simulated second.");
}

TEST(StudyAdvice, a_method_that_costs_the_same_within_the_scatter_is_not_called_dearer) {
  Study study = made_up_study();
  const auto with_cost = [&](double ratio) {
    study.runs[2].outcome.stepping_seconds = ratio * study.runs[5].outcome.stepping_seconds;
    return advice(study, read_target("10 mm"));
  };
  const std::string same = "; as fast within the noise of the timing is ";
  EXPECT_NE(with_cost(1.04).find(same), std::string::npos) << with_cost(1.04);
  EXPECT_NE(with_cost(0.96).find(same), std::string::npos) << with_cost(0.96);
  EXPECT_NE(with_cost(1.06).find("; next best is "), std::string::npos) << with_cost(1.06);
}

// Of repeated runs the times reach from the least to the median.
TEST(StudyAdvice, runs_whose_times_overlap_are_as_fast_and_the_more_accurate_one_is_advised) {
  Study study = made_up_study();
  auto &slow = study.runs[2], &quick = study.runs[5];  // 0.5 % and 0.8 % of error
  quick.outcome.stepping_seconds = 10;
  slow.outcome.stepping_seconds = 12;
  const auto is_called_as_fast = [&] {
    return advice(study, {.error = .01}).find("; as fast within the noise") != std::string::npos;
  };
  EXPECT_EQ(cheapest_within(study, {.error = .01}), &quick);
  EXPECT_FALSE(is_called_as_fast());
  slow.outcome.least_stepping_seconds = 11;
  EXPECT_EQ(cheapest_within(study, {.error = .01}), &quick);
  EXPECT_FALSE(is_called_as_fast());
  slow.outcome.least_stepping_seconds = 9;
  EXPECT_EQ(cheapest_within(study, {.error = .01}), &slow);
  EXPECT_TRUE(is_called_as_fast());
}

TEST(StudyAdvice, a_target_out_of_reach_is_said_to_be) {
  const std::string sentence = advice(made_up_study(), read_target("0.1 %"));
  EXPECT_NE(sentence.find("No run of this sweep is within 0.1 %"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("slow double, step factor 0.9, n = 8"), std::string::npos) << sentence;
}

TEST(StudyAdvice, broken_runs_and_the_reference_itself_are_never_advised) {
  Study study = made_up_study();
  study.runs[4].outcome.trouble = "inverted";
  study.runs[0].is_reference = true;
  EXPECT_EQ(cheapest_within(study, {.error = .05}), &study.runs[1]);
  EXPECT_EQ(cheapest_within(study, {.error = .09}), &study.runs[1]);
}

TEST(StudyAdvice, the_median_of_the_fronts_errors_is_the_target_by_default) {
  // .005 .008 .02 | .03 .08 .1: the lower one of the two in the middle, and a tenth more.
  const Target target = median_target(made_up_study());
  EXPECT_TRUE(target.is_length);
  EXPECT_DOUBLE_EQ(target.error, 1.1 * .02);
}

TEST(StudyAdvice, the_front_holds_the_runs_that_none_beats_in_both_cost_and_error) {
  // By cost: quick 2, slow 2, quick 4, slow 4, quick 8, slow 8; each has less error than all
  // before.
  Study study = made_up_study();
  EXPECT_EQ(pareto_front(study).size(), 6u);
  study.runs[1].outcome.stepping_seconds = 30;  // dearer than both n = 8, and worse
  const auto front = pareto_front(study);
  ASSERT_EQ(front.size(), 5u);
  EXPECT_EQ(front.front(), &study.runs[3]);
  EXPECT_EQ(front.back(), &study.runs[2]);
}

TEST(StudyAdvice, a_target_is_a_length_or_a_share) {
  EXPECT_EQ(read_target("2 mm").error, 2e-3);
  EXPECT_TRUE(read_target("2 mm").is_length);
  EXPECT_DOUBLE_EQ(read_target("1.5 %").error, .015);
  EXPECT_FALSE(read_target("1%").is_length);
  for (const char* wrong : {"", "much", "3 kPa", "% 3", "1 % or so", "%", "nan %", "inf %", "0 %",
                            "-1 %", "0x10 %", "-1 mm", "0 mm"})
    EXPECT_THROW(read_target(wrong), InputError) << wrong;
}

TEST(StudyAdvice, a_length_is_refused_where_the_result_is_none) {
  Study study = made_up_study();
  study.problem.length = 0;
  EXPECT_THROW(advice(study, read_target("1 mm")), InputError);
}

}  // namespace
}  // namespace trocar
