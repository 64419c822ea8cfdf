// What sleeps loses no more than the bound, wakes when it is touched or its surroundings move, and
// is the same after a restart. That ranks and threads don't matter is tested in tests/invariance.
#include "engine/sleep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/equilibrium.h"
#include "engine_checkpoint.h"
#include "engine_motion.h"
#include "engine_scene.h"
#include "engine_split.h"
#include "engine_started.h"
#include "larger_or_nan.h"
#include "scene_parts.h"

namespace trocar {
namespace {

// A probe presses one end from 0.8 s to 2.6 s.
const std::string pressed_bar = time_table("3.2 s") + bar_on_table() + probe_along(R"(
  { time = "0.7 s", position = ["-50 mm", 0, "30 mm"] },
  { time = "1.2 s", position = ["-50 mm", 0, "17 mm"] },
  { time = "2.3 s", position = ["-50 mm", 0, "17 mm"] },
  { time = "2.8 s", position = ["-46 mm", 0, "40 mm"] },
)");
constexpr double bound = 0.1e-3;

std::unique_ptr<Started> started_bar(const std::vector<std::string>& overrides,
                                     const std::string& text = pressed_bar) {
  auto run = built(text, overrides);
  start_in_equilibrium(run->loaded, *run->s);
  return run;
}

const std::string in_equilibrium = "[start]\nstate = \"equilibrium\"\n";
const std::vector<std::string> with_sleep = {"solver.sleep='0.1 mm'"};

TEST(Sleep, leaves_supports_the_weight) {
  const auto run =
      started_bar({"solver.sleep='0.1 mm'", "output=[{kind='metrics', file='m.csv'}]"});
  while (run->s->frame < 20) run_frame(*run->s, run->outputs);
  EXPECT_GT(run->s->sleep->share, 0.9);
  double weight = 0;
  for (const double m : run->s->mass) weight += 9.81 * m;
  const Vec3 force = run->s->log.rows.back().support_forces[0];
  EXPECT_LT((force - Vec3(0, 0, -weight)).norm(), 1e-3 * weight);
}

TEST(Sleep, changes_displacements_by_less_than_the_bound_while_much_is_asleep) {
  const auto awake = started_bar({}), sleepy = started_bar(with_sleep);
  double most = 0, moved = 0, share_while_pressed = 0;
  const auto start = awake->s->state.u;
  while (awake->s->frame < 96) {
    run_frame(*awake->s, awake->outputs);
    run_frame(*sleepy->s, sleepy->outputs);
    most = larger_or_nan(most, largest_difference(awake->s->state.u, sleepy->s->state.u));
    moved = larger_or_nan(moved, largest_difference(awake->s->state.u, start));
    if (awake->s->frame > 54 && awake->s->frame <= 69)  // a second and more after the first touch
      share_while_pressed = larger_or_nan(share_while_pressed, sleepy->s->sleep->share);
  }
  EXPECT_LT(most, bound);
  EXPECT_GT(most, 0);            // it did leave something out
  EXPECT_GT(moved, 10 * bound);  // and that is not because nothing happened
  EXPECT_GT(share_while_pressed, .25);
  std::printf("largest difference %.3g m, motion %.3g m, share asleep while pressed %.2f\n", most,
              moved, share_while_pressed);
}

// A soft strip that takes six seconds for a swing stopped for good where it first turned back, 4.3
// mm off, while half a second of quiet was enough.
TEST(Sleep, lets_slow_motion_turn_back) {
  const std::string strip =
      "[time]\nduration = 30\nframe_rate = 20\n[tissue.shape]\nkind = \"box\"\n"
      "elements = \"hex8\"\nlow = [0, 0, 0]\nhigh = [0.1, 0.01, 0.005]\ncells = [20, 2, "
      "2]\n[tissue.material]\n"
      "young_modulus = 1000\npoisson_ratio = 0.3\n[solver]\nhexahedron = \"enhanced\"\n"
      "mass_damping = 0.5\n[[support]]\nregion = \"x-\"\n"
      "[[load]]\nregion = \"x+\"\nforce = [0, 0, 2e-6]\n";
  const auto awake = built(strip), sleepy = built(strip, {"solver.sleep='1 mm'"});
  double most = 0, moved = 0;
  while (awake->s->frame < 600) {
    run_frame(*awake->s, awake->outputs);
    run_frame(*sleepy->s, sleepy->outputs);
    most = larger_or_nan(most, largest_difference(awake->s->state.u, sleepy->s->state.u));
    moved = larger_or_nan(moved, *std::ranges::max_element(awake->s->state.u));
  }
  std::printf("quiet time %.2f s, largest difference %.3g m of %.3g, share asleep %.2f\n",
              sleepy->s->sleep->quiet_time, most, moved, sleepy->s->sleep->share);
  EXPECT_GT(moved, 5e-3);
  EXPECT_LT(most, 1e-3);
  EXPECT_GT(sleepy->s->sleep->share, 0);  // at the end
}

TEST(Sleep, comes_over_a_body_at_rest_after_half_a_second_and_ends_with_the_first_contact) {
  const auto run = started_bar(with_sleep);
  Simulation& s = *run->s;
  while (s.frame < 15) run_frame(s, run->outputs);
  EXPECT_EQ(s.sleep->share, 0);  // 14 intervals of rest so far, half a second takes 15
  run_frame(s, run->outputs);
  EXPECT_EQ(s.sleep->share, 1);
  while (s.contact->contacts.empty() && s.frame < 96) run_frame(s, run->outputs);
  EXPECT_LT(s.frame, 96);
  EXPECT_EQ(s.sleep->share, 0);
}

TEST(Sleep, leaves_sleeping_nodes_where_they_are_without_velocity) {
  const auto run = started_bar(with_sleep);
  Simulation& s = *run->s;
  while (s.frame < 66) run_frame(s, run->outputs);
  ASSERT_GT(s.sleep->share, 0);
  ASSERT_LT(s.sleep->share, 1);
  const State before = s.state;
  const std::vector<std::uint8_t> asleep = s.sleep->is_asleep;
  run_frame(s, run->outputs);
  ASSERT_GE(s.sleep->share, 0);
  for (std::size_t k = 0; k < before.u.size(); ++k) {
    if (asleep[k / 3] == 0 || s.sleep->is_asleep[k / 3] == 0) continue;
    EXPECT_EQ(s.state.u[k], before.u[k]);
    EXPECT_EQ(s.state.v[k], 0);
  }
}

// Blocks are left out only where nobody asks for the force: with all blocks computed the same bits
// come out at nodes that are awake.
TEST(Sleep, forces_at_awake_nodes_do_not_depend_on_the_blocks_left_out) {
  const auto run = started_bar(with_sleep);
  Simulation& s = *run->s;
  while (s.frame < 66) run_frame(s, run->outputs);
  ASSERT_GT(std::count(s.scratch.is_asleep.begin(), s.scratch.is_asleep.end(), 1), 0);
  find_force(s.model, s.neighbours, s.state, s.scratch);
  const std::vector<double> force = s.scratch.force;
  s.scratch.is_asleep.clear();
  find_force(s.model, s.neighbours, s.state, s.scratch);
  for (std::size_t k = 0; k < force.size(); ++k)
    if (s.sleep->is_asleep[k / 3] == 0) {
      EXPECT_EQ(force[k], s.scratch.force[k]);
    }
  EXPECT_NE(force, s.scratch.force);
}

TEST(Sleep, goes_on_after_a_restart_with_the_same_bits) {
  const auto whole = started_bar(with_sleep);
  while (whole->s->frame < 67) run_frame(*whole->s, whole->outputs);
  for (const std::int64_t frame : {10, 30, 66}) {
    const auto first = started_bar(with_sleep);
    while (first->s->frame < frame) run_frame(*first->s, first->outputs);
    const std::vector<std::byte> bytes = checkpoint_to_bytes(take_checkpoint(*first->s));
    const auto second = built(pressed_bar, with_sleep);
    restore_checkpoint(checkpoint_from_bytes(bytes, "c"), *second->s);
    EXPECT_EQ(second->s->sleep->share, first->s->sleep->share);
    while (second->s->frame < 67) run_frame(*second->s, second->outputs);
    EXPECT_EQ(second->s->state.u, whole->s->state.u) << frame;
    EXPECT_EQ(second->s->sleep->is_asleep, whole->s->sleep->is_asleep) << frame;
  }
}

// What sleep changed in a scene, and how much of the body slept before and woke after `moment`.
struct SleepEffect {
  double most = 0, moved = 0;
  double share_before = 0, least_share_after = 1;
};

SleepEffect compare(const std::string& text, std::int64_t moment, std::int64_t n_frames) {
  const auto awake = started_bar({}, text), sleepy = started_bar(with_sleep, text);
  SleepEffect compared;
  const auto start = awake->s->state.u;
  while (awake->s->frame < n_frames) {
    run_frame(*awake->s, awake->outputs);
    run_frame(*sleepy->s, sleepy->outputs);
    // After a cut the two bodies may have been cut apart elsewhere.
    if (awake->s->state.u.size() == start.size() && sleepy->s->state.u.size() == start.size())
      compared.most =
          larger_or_nan(compared.most, largest_difference(awake->s->state.u, sleepy->s->state.u));
    const double share = sleepy->s->sleep->share;
    if (awake->s->frame == moment) compared.share_before = share;
    if (awake->s->frame > moment)
      compared.least_share_after = std::min(compared.least_share_after, share);
  }
  for (std::size_t k = 0; k < start.size(); ++k)
    compared.moved = larger_or_nan(compared.moved, std::abs(awake->s->state.u[k] - start[k]));
  return compared;
}

// Without the probe, and with something else.
std::string bar_with(const std::string& more) {
  return pressed_bar.substr(0, pressed_bar.find("[[instrument]]")) + more;
}

TEST(Sleep, ends_when_a_support_moves) {
  const SleepEffect compared = compare(bar_with(R"([[support]]
region = "x-"
path = [
  { time = "1.0 s", displacement = [0, 0, 0] },
  { time = "1.3 s", displacement = ["-3 mm", 0, 0] },
]
)"),
                                       29, 60);
  EXPECT_GT(compared.share_before, 0.8);  // all but the support and what hangs on it
  EXPECT_EQ(compared.least_share_after, 0);
  EXPECT_LT(compared.most, bound);
  EXPECT_GT(compared.moved, 20 * bound);
}

TEST(Sleep, ends_before_a_blade_cuts_hexahedra) {
  const std::string text = bar_with(R"([[instrument]]
kind = "scalpel"
blade_length = "20 mm"
path = [
  { time = "0.8 s", position = ["-40 mm", "1 mm", "40 mm"] },
  { time = "1.2 s", position = ["-40 mm", "1 mm", "11 mm"] },
  { time = "1.5 s", position = ["-15 mm", "1 mm", "11 mm"] },
]
)");
  const auto run = started_bar(with_sleep, text);
  Simulation& s = *run->s;
  const std::int32_t n_nodes = s.mesh.n_nodes();
  while (s.frame < 24) run_frame(s, run->outputs);
  EXPECT_EQ(s.sleep->share, 1);
  while (s.frame < 48) {
    const bool cuts = s.cuts[0].is_engaged;
    run_frame(s, run->outputs);
    if (cuts) {
      EXPECT_EQ(s.sleep->share, 0) << s.frame;
    }
  }
  EXPECT_GT(s.mesh.n_nodes(), n_nodes);
  EXPECT_EQ(s.sleep->quiet.size(), static_cast<std::size_t>(s.mesh.n_nodes()));
}

// It wakes, is split, sleeps again, and each goes on after a restart with the same bits.
TEST(Sleep, ends_where_a_cut_splits_elements_and_comes_back) {
  const std::string text = plate_of("tet4-five") +
                           "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n" +
                           in_equilibrium;
  const std::vector<std::string> light = {"solver.sleep='0.1 mm'", "solver.gravity=[0,0,-0.01]"};
  const auto run_to = [](Started& run, std::int64_t frame) {
    while (run.s->frame < frame) run_frame(*run.s, run.outputs);
  };
  const auto whole = started_bar(light, text);
  Simulation& s = *whole->s;
  run_to(*whole, 35);
  EXPECT_EQ(s.sleep->share, 1);
  const PlateSplit done = split_plate(s);
  ASSERT_GT(done.n_inserted, 300);
  EXPECT_EQ(s.n_pieces, 2);
  EXPECT_EQ(s.sleep->share, 0);
  EXPECT_EQ(s.sleep->quiet.size(), static_cast<std::size_t>(s.mesh.n_nodes()));
  std::vector<std::unique_ptr<Started>> resumed;
  for (const std::int64_t frame : {35, 50, 70}) {
    run_to(*whole, frame);
    resumed.push_back(built(text, light));
    const std::vector<std::byte> bytes = checkpoint_to_bytes(take_checkpoint(s));
    restore_checkpoint(checkpoint_from_bytes(bytes, "c"), *resumed.back()->s);
  }
  run_to(*whole, 90);
  EXPECT_GT(s.sleep->share, 0.9);
  for (const auto& other : resumed) {
    run_to(*other, 90);
    EXPECT_EQ(other->s->state.u, s.state.u);
    EXPECT_EQ(other->s->sleep->is_asleep, s.sleep->is_asleep);
  }
}

TEST(Sleep, is_refused_for_viscoelastic_tissue) {
  const std::string sentence =
      scene_error(scene_text("[tissue.material]\nprony = [ { share = 0.4, time = 0.02 } ]\n"
                             "[solver]\nsleep = \"0.1 mm\"\n"));
  EXPECT_TRUE(contains(sentence, "solver.sleep")) << sentence;
}

TEST(Sleep, is_absent_unless_it_is_asked_for) {
  EXPECT_FALSE(started_bar({})->s->sleep.has_value());
}

}  // namespace
}  // namespace trocar
