#include "engine/frame_watch.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/log.h"
#include "engine/body_search.h"
#include "engine/frame.h"
#include "engine_started.h"
#include "solver/step.h"
#include "solver_body.h"

namespace trocar {
namespace {

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

Simulation sound_simulation() {
  start_log(0, true);
  Simulation s;
  s.watch.stable_step = 1e-4;
  s.watch.least_J = 0.8;
  s.watch.least_J_element = 7;
  s.scene.time.frame_rate = 30;
  return s;
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

}  // namespace
}  // namespace trocar
