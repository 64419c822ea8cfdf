#include "engine/roll_back.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/log.h"
#include "base/threads.h"
#include "engine_checkpoint.h"
#include "engine_resume.h"
#include "engine_started.h"
#include "mesh_fixtures.h"
#include "mesh_write.h"
#include "scene_parts.h"
#include "solver/step.h"

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

// Pressed, grasped, pulled by a support and cut with resistance; with all that metrics tell.
const std::string busy_block = resume_block_text + metrics_table;

// Pressed beside its thin elements, which take local steps, and pulled.
const std::string busy_layer = time_table("1 s", 50) + tissue_of_kpa(2) + solver_table("-1", 20) +
                               "multirate = true\n" + held_left + metrics_table + probe_along(R"(
  { time = 0, position = ["45 mm", "15 mm", "36 mm"] },
  { time = 0.3, position = ["45 mm", "15 mm", "28 mm"] },
)") + grasper_along("7 mm", R"(
  { time = 0, position = ["70 mm", "-20 mm", "-20 mm"] },
  { time = "0.1 s", position = ["70 mm", 0, 0], action = "close" },
  { time = "0.3 s", position = ["72 mm", "-3 mm", "-2 mm"] },
)");

std::vector<std::string> layer_file(const TestFolder& folder) {
  write_mesh(with_thin_layer(BoxElements::hex8, 2), folder.file("m.msh"));
  return {"tissue.mesh='" + folder.file("m.msh") + "'"};
}

// But for the sentences on its roll-backs.
std::vector<std::byte> told_by(Simulation& s) {
  Checkpoint c = without_wall_times(take_checkpoint(s));
  std::erase_if(c.tally.events, [](const std::string& e) { return contains(e, "rolled back"); });
  return checkpoint_to_bytes(c);
}

// From the end of a frame on, of two: in one the force at a node is not a number in the first try,
// the other begins with what a roll-back leaves.
void expect_frames_of_smaller_step(const std::string& text, const std::vector<std::string>& more,
                                   int frame) {
  const auto before = built(text, more), failing = built(text, more), direct = built(text, more);
  while (before->s->frame < frame) run_frame(*before->s, before->outputs);
  const Checkpoint start = take_checkpoint(*before->s);
  Simulation &s = *failing->s, &expected = *direct->s;
  for (Simulation* const t : {&s, &expected}) restore_checkpoint(start, *t);
  find_force(s.model, s.neighbours, s.state, s.scratch);
  s.scratch.force[s.scratch.force.size() / 2] = not_a_number;
  s.scratch.has_force = true;
  roll_back(expected, {.t0 = expected.state.time}, expected.watch, "as the other", 0);
  for (int k = 0; k < 2; ++k) {
    run_frame(s, failing->outputs);
    run_frame(expected, direct->outputs);
    EXPECT_EQ(s.log.n_roll_backs, 1);
    EXPECT_TRUE(told_by(s) == told_by(expected)) << k + 1 << " frames after frame " << frame;
    const FrameRow &row = s.log.rows.back(), &other = expected.log.rows.back();
    EXPECT_GT(row.n_contacts, 0);
    EXPECT_GT(row.n_held, 0);
    EXPECT_GT(row.tools[1].pull.norm(), 0);  // of the grasper
    EXPECT_EQ(row.tools[1].pull, other.tools[1].pull);
  }
}

// The grasper closes at the beginning of the seventh frame.
TEST(RollBack, gives_the_frames_that_the_smaller_step_gives_at_once) {
  set_thread_count(1);
  for (const std::string& text : {busy_block, busy_block + "[contact]\ntissue = true\n"})
    for (const int frame : {6, 12, 20}) expect_frames_of_smaller_step(text, {}, frame);
  const TestFolder folder;
  expect_frames_of_smaller_step(busy_layer, layer_file(folder), 8);
}

// Each of its tries is said to have crushed an element, and searches for the step.
TEST(RollBack, that_gives_up_leaves_the_steps_of_before) {
  const TestFolder folder;
  const auto started = built(busy_layer, layer_file(folder));
  Simulation& s = *started->s;
  while (s.frame < 8) run_frame(s, started->outputs);
  ASSERT_TRUE(s.has_local_steps);
  const double of_small = s.look.of_small, step = s.watch.stable_step;
  const std::int64_t n_searches = s.log.searches.n_of_body;
  ASSERT_LT(of_small, 0.5);
  s.rest_step = 1;  // [s] said to be that at rest
  const std::string sentence = error_of<SimulationError>([&] { run_frame(s, started->outputs); });
  EXPECT_TRUE(contains(sentence, "crushed or overstretched")) << sentence;
  EXPECT_GT(s.log.searches.n_of_body, n_searches);
  EXPECT_EQ(s.look.of_small, of_small);
  EXPECT_EQ(s.watch.stable_step, step);
}

}  // namespace
}  // namespace trocar
