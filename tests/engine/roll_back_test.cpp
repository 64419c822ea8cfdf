#include "engine/roll_back.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/log.h"
#include "engine_started.h"

namespace trocar {
namespace {

TEST(RollBack, halves_the_step_and_says_why) {
  start_log(0, true);
  Simulation s;
  roll_back(s, {.t0 = 1}, s.watch, "element 7 is inverted", 0);
  EXPECT_EQ(s.step_scale, 0.5);
  EXPECT_EQ(s.log.n_roll_backs, 1);
  ASSERT_EQ(s.log.events.size(), 1u);
  EXPECT_TRUE(contains(s.log.events[0], "1.000 s: rolled back: element 7 is inverted"));
}

TEST(RollBack, gives_up_after_its_last_try_with_time_cause_and_place) {
  const auto started = block_of("tet4-kuhn");
  Simulation& s = *started->s;
  const FrameSpan span{.t0 = 0.5, .t1 = 0.6};
  const Watch failed{.least_J = -1, .least_J_element = 0};
  for (int tries = 0; tries < most_roll_backs; ++tries) roll_back(s, span, failed, "t", tries);
  const std::string sentence = error_of<SimulationError>(
      [&] { roll_back(s, span, failed, "element 0 is inverted", most_roll_backs); });
  EXPECT_TRUE(contains(sentence, "in the frame after 0.5 s: element 0 is inverted at (0.0"))
      << sentence;
  EXPECT_TRUE(contains(sentence, " m; 4 roll-backs")) << sentence;  // nothing moves
  EXPECT_EQ(s.log.n_roll_backs, most_roll_backs);
}

TEST(RepeatFrame, keeps_the_new_stable_step_and_the_scale_and_says_why) {
  start_log(0, true);
  Simulation s;
  s.watch.stable_step = 1e-4;
  const double scale = s.step_scale;
  repeat_frame(s, {.t0 = 0.5, .t1 = 0.6, .dt = 2e-4}, 0);
  EXPECT_EQ(s.step_scale, scale);
  EXPECT_EQ(s.watch.stable_step, 1e-4);
  EXPECT_EQ(s.log.n_roll_backs, 1);
  EXPECT_TRUE(
      contains(s.log.events.back(), "stable step fell to 0.0001 s, below the step of 0.0002"))
      << s.log.events.back();
  s.watch.stable_element = -1;  // not known
  EXPECT_THROW(repeat_frame(s, {.dt = 2e-4}, most_roll_backs), SimulationError);
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Swings for a frame, from a node that was pushed; forces of the next step are known.
std::unique_ptr<Started> swung(const std::string& elements) {
  auto started = block_of(elements);
  started->s->state.v[2] = 0.3;
  run_frame(*started->s, started->outputs);
  EXPECT_TRUE(started->s->scratch.has_force);
  return started;
}

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

// The frame's beginning has none of it.
TEST(RollBack, once_leaves_a_force_that_is_not_finite_behind) {
  for (const std::string elements : {"hex8", "tet4-kuhn"})
    for (const double bad : {not_a_number, std::numeric_limits<double>::infinity(), 1e200}) {
      const auto started = swung(elements);
      Simulation& s = *started->s;
      ASSERT_EQ(s.log.n_roll_backs, 0);
      s.scratch.force[s.scratch.force.size() / 2] = bad;
      for (int frame = 0; frame < 3; ++frame) run_frame(s, started->outputs);
      EXPECT_EQ(s.log.n_roll_backs, 1);
      ASSERT_EQ(s.log.events.size(), 1u);
      EXPECT_TRUE(
          contains(s.log.events[0], "rolled back: a non-finite displacement or velocity at node "))
          << s.log.events[0];
      EXPECT_TRUE(contains(s.log.events[0], "step scale now 0.5")) << s.log.events[0];
      EXPECT_EQ(s.frame, 4);
      EXPECT_TRUE(all_finite(s.state.u) && all_finite(s.state.v));
    }
}

TEST(RollBack, of_numbers_that_stay_not_finite_ends_in_a_sentence_with_node_and_cause) {
  for (std::vector<double> State::*const field : {&State::u, &State::v}) {
    const auto started = swung("hex8");
    Simulation& s = *started->s;
    (s.state.*field)[(s.state.*field).size() / 2] = not_a_number;
    s.scratch.has_force = false;
    const std::string sentence = error_of<SimulationError>([&] { run_frame(s, started->outputs); });
    EXPECT_TRUE(contains(sentence, "in the frame after 0.03")) << sentence;
    EXPECT_TRUE(contains(sentence, ": a non-finite displacement or velocity at node ")) << sentence;
    EXPECT_TRUE(contains(sentence, "(the step was unstable or a load is not finite)")) << sentence;
    EXPECT_TRUE(contains(sentence, "; 4 roll-backs with smaller steps did not help: ")) << sentence;
    EXPECT_EQ(s.frame, 1);
    EXPECT_EQ(s.log.rows.size(), 1u);
    EXPECT_EQ(s.log.n_roll_backs, most_roll_backs);
  }
}

}  // namespace
}  // namespace trocar
