#include "engine/frame_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/log.h"
#include "base/timers.h"
#include "engine/frame.h"
#include "engine/part_search.h"
#include "engine_started.h"
#include "solver/frequency.h"
#include "solver/step.h"
#include "solver_body.h"

namespace trocar {
namespace {

Simulation sound_simulation() {
  start_log(0, true);
  Simulation s;
  s.watch.stable_step = 1e-4;
  s.watch.least_J = 0.8;
  s.watch.least_J_element = 7;
  s.scene.time.frame_rate = 30;
  return s;
}

// Irregular tetrahedra or hexahedra, with what they are looked at for.
std::unique_ptr<Started> block_of(const std::string& elements, int n = 4) {
  const std::string cells = std::to_string(n);
  return built(R"([time]
duration = "1 s"
[tissue.shape]
kind = "box"
cells = [4, 4, 4]
[tissue.material]
young_modulus = "3 kPa"
poisson_ratio = 0.45
)",
               {"tissue.shape.elements='" + elements + "'",
                "tissue.shape.cells=[" + cells + "," + cells + "," + cells + "]"});
}

TEST(Deadline, of_a_frame_does_not_depend_on_how_late_others_were) {
  Simulation s;
  s.scene.time.frame_rate = 4;
  s.start_seconds = 100;
  s.frame = 3;
  EXPECT_EQ(left_of_frame(s, 100), 0.75);
  EXPECT_EQ(left_of_frame(s, 100.75), 0);
  EXPECT_EQ(left_of_frame(s, 102), -1.25);
}

// However quickly the frame was computed: outputs may have taken the time.
TEST(Deadline, that_is_past_counts_as_missed_in_real_time_alone) {
  const auto run = block_of("hex8", 2);
  Simulation& s = *run->s;
  s.start_seconds = monotonic_seconds() - 10;
  s.frame = 1;
  wait_for_deadline(s);
  EXPECT_EQ(s.log.n_deadlines_missed, 0);
  s.scene.time.pace = Pace::real_time;
  wait_for_deadline(s);
  wait_for_deadline(s);
  EXPECT_EQ(s.log.n_deadlines_missed, 2);
}

// The corners of an element that move as far as they may, in random directions.
TEST(WatchState, leaves_elements_alone_while_their_strains_cannot_be_seen) {
  for (const std::string elements : {"hex8", "tet4-kuhn"}) {
    const auto run = block_of(elements);
    Simulation& s = *run->s;
    const Watch at_rest = s.watch;
    s.watch.least_J_element = 4711;  // any look would find another
    Noise noise(3);
    for (double& u : s.state.u) u = noise() < 0 ? -s.look.reach : s.look.reach;
    watch_state(s);
    EXPECT_EQ(s.watch.least_J_element, 4711);
    s.look.is_done = false;
    watch_state(s);
    EXPECT_NE(s.watch.least_J_element, 4711);
    EXPECT_NEAR(s.watch.least_J, 1, 3.01 * unseen_strain);  // det (I + H) = 1 + tr H + ...
    EXPECT_LT(s.watch.least_J, 1 - 0.2 * unseen_strain);    // the bound is not idle
    // A percent, and what a search may stop short of (frequency_margin).
    EXPECT_NEAR(s.watch.stable_step / at_rest.stable_step, 1, 0.03);
  }
}

TEST(WatchState, looks_at_elements_again_once_a_node_has_left) {
  const auto run = block_of("hex8");
  Simulation& s = *run->s;
  s.watch.least_J_element = 4711;
  s.state.u[0] = 1.01 * s.look.reach;
  watch_state(s);
  EXPECT_NE(s.watch.least_J_element, 4711);
}

// Stretches the layers of the block above the middle by `strain` along z.
void stretch_upper_half(Simulation& s, double strain) {
  double low = 1e300, high = -1e300;
  for (const Vec3& X : s.mesh.X) low = std::min(low, X.z()), high = std::max(high, X.z());
  const double middle = (low + high) / 2;
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i)
    s.state.u[3 * i + 2] = strain * std::max(0.0, s.mesh.X[i].z() - middle);
}

// One that starts where the fastest mode was before, in the half at rest, would not see that one of
// the other half has become faster.
TEST(WatchState, never_gives_a_longer_step_than_a_search_of_the_body_as_it_is) {
  for (const std::string elements : {"hex8", "tet4-kuhn"}) {
    const auto run = block_of(elements);
    Simulation& s = *run->s;
    const double at_rest = s.watch.stable_step;
    int n_searches = 0;
    for (int k = 1; k <= 40; ++k) {
      stretch_upper_half(s, 0.01 * k);
      s.state.step += 10;
      watch_state(s);
      n_searches += s.look.at_step == s.state.step ? 1 : 0;
      const double whole = search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
      EXPECT_LT(s.watch.stable_step / whole, frequency_margin) << elements << ' ' << k;
      EXPECT_GT(s.watch.stable_step / whole, 1 / std::sqrt(most_growth) / frequency_margin);
    }
    EXPECT_LT(s.watch.stable_step, 0.75 * at_rest);
    EXPECT_GT(n_searches, 2);
    EXPECT_LT(n_searches, 30);
  }
}

// Stretches some cells in the middle of the block by `strain` along z.
void stretch_middle(Simulation& s, double strain) {
  Box box;
  for (const Vec3& X : s.mesh.X) box.add(X);
  const Vec3 middle = (box.low + box.high) / 2;
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i) {
    const Vec3 r = s.mesh.X[i] - middle;
    const double far = r.squaredNorm() / (4 * s.edge_length * s.edge_length);
    s.state.u[3 * i + 2] = strain * std::exp(-far) * r.z();
  }
  s.scratch.has_force = false;
}

TEST(WatchState, searches_the_part_alone_that_has_stiffened_and_gives_no_longer_step) {
  for (const auto& [elements, n] : {std::pair("hex8", 24), std::pair("tet4-kuhn", 30)}) {
    const auto run = block_of(elements, n);
    Simulation& s = *run->s;
    const std::int64_t of_body = s.log.searches.n_of_body;
    double least = 1;
    for (int k = 1; k <= 20; ++k) {
      stretch_middle(s, 0.05 * (k <= 15 ? k : 30 - k));
      s.state.step += 10;
      watch_state(s);
      const double whole = search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
      EXPECT_LT(s.watch.stable_step / whole, frequency_margin) << elements << ' ' << k;
      const double least_share = k <= 15 ? 1 / std::sqrt(most_growth_of_part) : 0.88;  // it softens
      EXPECT_GT(s.watch.stable_step / whole, least_share / frequency_margin)
          << elements << ' ' << k;
      least = std::min(least, whole / s.look.step);
    }
    EXPECT_LT(least, 0.99) << "the body has become no faster";
    EXPECT_GT(s.log.searches.n_of_parts, 6) << elements;
    EXPECT_EQ(s.log.searches.n_of_body, of_body) << elements;
  }
}

// A part is not asked whether the rest has softened.
TEST(WatchState, searches_the_body_in_place_of_a_part_long_after) {
  const auto run = block_of("hex8", 16);
  Simulation& s = *run->s;
  s.state.step = s.look.at_step + most_steps_of_parts + 1;
  stretch_middle(s, 0.3);
  watch_state(s);
  EXPECT_EQ(s.log.searches.n_of_parts, 0);
  EXPECT_EQ(s.look.at_step, s.state.step);
}

TEST(WatchState, takes_the_growth_of_elements_for_that_of_the_body_between_two_searches) {
  const auto run = block_of("tet4-kuhn");
  Simulation& s = *run->s;
  const double searched = s.look.step;
  stretch_upper_half(s, 0.01);
  s.state.step = 10;
  watch_state(s);
  EXPECT_EQ(s.look.at_step, 0);
  std::vector<double> stiffening(s.part.element_global.size());
  watch(s.model, s.part, s.state, stiffening);  // of a body that was at rest, where all are 1
  const double growth = std::ranges::max(stiffening);
  EXPECT_GT(growth, 1.005);
  EXPECT_EQ(s.watch.stable_step, searched / std::sqrt(growth));
  // Long after, what may have softened is looked for.
  stretch_upper_half(s, 0.005);
  s.state.step = most_steps_of_search;
  watch_state(s);
  EXPECT_EQ(s.look.at_step, most_steps_of_search);
  EXPECT_EQ(s.watch.stable_step,
            search_step(s, search_amplitude(s.model, s.edge_length), Communicator()));
}

// Swings in its weight for some frames; before each, `forget` may drop what the look left.
template <class Forget>
State swing(const std::string& elements, const Forget& forget) {
  const auto run = block_of(elements);
  Simulation& s = *run->s;
  s.state.v[2] = 0.3;
  Outputs outputs;
  for (int frame = 0; frame < 5; ++frame) {
    forget(s);
    run_frame(s, outputs);
  }
  return s.state;
}

TEST(WatchState, leaves_the_forces_of_the_next_step_and_searches_keep_them) {
  for (const std::string elements : {"hex8", "tet4-kuhn"}) {
    const State computed = swing(elements, [](Simulation& s) { s.scratch.has_force = false; });
    int n_left = 0;
    const State left = swing(elements, [&](Simulation& s) {
      n_left += s.scratch.has_force ? 1 : 0;
      search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
    });
    EXPECT_GE(n_left, 4);
    EXPECT_EQ(left.u, computed.u);
    EXPECT_EQ(left.v, computed.v);
  }
}

TEST(WatchState, leaves_no_forces_where_a_step_has_moved_the_nodes_since) {
  const auto run = block_of("hex8");
  Simulation& s = *run->s;
  s.state.u[0] = 1.01 * s.look.reach;
  watch_state(s);
  EXPECT_TRUE(s.scratch.has_force);
  integrate(s.model, s.scratch, {}, 1e-6, s.state);
  EXPECT_FALSE(s.scratch.has_force);
}

TEST(FindTrouble, is_silent_while_all_is_well) {
  EXPECT_EQ(find_trouble(sound_simulation()), "");
}

TEST(FindTrouble, names_the_node_that_is_not_finite_before_anything_else) {
  Simulation s = sound_simulation();
  s.watch.is_finite = false;
  s.watch.bad_node = 4711;
  s.watch.least_J = -1;
  EXPECT_TRUE(contains(find_trouble(s), "node 4711"));
}

TEST(FindTrouble, names_the_inverted_element) {
  Simulation s = sound_simulation();
  for (const double J : {0.0, -0.0, -1e-300, -3.0, std::numeric_limits<double>::quiet_NaN()}) {
    s.watch.least_J = J;
    EXPECT_TRUE(contains(find_trouble(s), "element 7 is inverted")) << J;
  }
  s.watch.least_J = 1e-300;
  EXPECT_EQ(find_trouble(s), "");
}

TEST(FindTrouble, names_the_element_whose_stable_step_falls_below_a_hundredth_of_the_rests) {
  Simulation s = sound_simulation();
  s.rest_step = 99 * s.watch.stable_step;
  EXPECT_EQ(find_trouble(s), "");
  s.rest_step = 101 * s.watch.stable_step;
  s.watch.stable_element = 12;
  EXPECT_TRUE(contains(find_trouble(s), "element 12 is crushed")) << find_trouble(s);
}

TEST(RollBack, halves_the_step_and_forgets_the_reactions_of_the_failed_frame) {
  Simulation s = sound_simulation();
  s.holds.reaction_sum = {Vec3(1, 2, 3)};
  roll_back(s, {.t0 = 1}, s.watch, "element 7 is inverted", 0);
  EXPECT_EQ(s.step_scale, 0.5);
  EXPECT_EQ(s.log.n_roll_backs, 1);
  EXPECT_EQ(s.holds.reaction_sum[0], Vec3::Zero());
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
  Simulation s = sound_simulation();
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

}  // namespace
}  // namespace trocar
