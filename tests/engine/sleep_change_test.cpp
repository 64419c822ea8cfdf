// What is let go, or cut free, is as slow as it then is: what was known of it before says nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/settling.h"
#include "engine/sleep.h"
#include "engine_motion.h"
#include "engine_scene.h"
#include "engine_started.h"
#include "replaced.h"

namespace trocar {
namespace {

// A bar whose end a grasper lifts and lets go of at 2 s.
const std::string lifted_bar = R"([time]
duration = "10 s"
frame_rate = 1000
[tissue.shape]
kind = "box"
low = [0, 0, 0]
high = ["60 mm", "20 mm", "20 mm"]
cells = [6, 2, 2]
[tissue.material]
young_modulus = "3 kPa"
[solver]
mass_damping = "60 1/s"
[[support]]
region = "x-"
[[instrument]]
kind = "grasper"
radius = "2 mm"
grip_radius = "18 mm"
path = [
  { time = 0, position = ["72 mm", "10 mm", "10 mm"], forward = [0, 1, 0], action = "open" },
  { time = 0.2, position = ["72 mm", "10 mm", "10 mm"], forward = [0, 1, 0], action = "close" },
  { time = 0.6, position = ["72 mm", "10 mm", "13 mm"], forward = [0, 1, 0] },
  { time = 2, position = ["72 mm", "10 mm", "13 mm"], forward = [0, 1, 0], action = "open" },
]
)";

// A bar on a table, which a blade cuts into a flap that rises slowly.
const std::string slow_flap = R"([time]
duration = "150 s"
frame_rate = 10
[tissue.shape]
kind = "box"
elements = "tet4-kuhn"
low = [0, 0, 0]
high = ["80 mm", "16 mm", "16 mm"]
cells = [10, 2, 4]
[tissue.material]
young_modulus = "3 kPa"
[solver]
gravity = [0, 0, 0.2]
mass_damping = "600 1/s"
[[support]]
region = "z-"
[[instrument]]
kind = "scalpel"
radius = "0.5 mm"
blade_length = "40 mm"
path = [
  { time = 3, position = ["100 mm", "-10 mm", "8 mm"], direction = [0, -1, 0], forward = [-1, 0, 0] },
  { time = 4, position = ["12 mm", "-10 mm", "8 mm"], direction = [0, -1, 0], forward = [-1, 0, 0] },
  { time = 4.5, position = ["100 mm", "-10 mm", "8 mm"], direction = [0, -1, 0], forward = [-1, 0, 0] },
]
)";

// A probe bends a bar at 0.5 s, rests, and leaves it at 4 s.
const std::string bent_bar = R"([time]
duration = "6 s"
frame_rate = 50
[tissue.shape]
kind = "box"
low = [0, "-5 mm", "-5 mm"]
high = ["50 mm", "5 mm", "5 mm"]
cells = [10, 2, 2]
[tissue.material]
young_modulus = "30 kPa"
poisson_ratio = 0.3
[solver]
mass_damping = "20 1/s"
[[support]]
region = "x-"
[[instrument]]
kind = "probe"
radius = "4 mm"
path = [
  { time = 0, position = ["35 mm", 0, "5.1 mm"] },
  { time = 0.5, position = ["35 mm", 0, "2.5 mm"] },
  { time = 4, position = ["35 mm", 0, "2.5 mm"] },
  { time = 4.5, position = ["35 mm", 0, "10 mm"] },
]
)";

struct LastFrame {
  std::vector<double> u;
  double share_asleep = 0;
};

LastFrame last_frame(const std::string& text, const std::vector<std::string>& overrides) {
  const auto run = built(text, overrides);
  Simulation& s = *run->s;
  const auto n = std::lround(s.scene.time.duration * s.scene.time.frame_rate);
  while (s.frame < n) run_frame(s, run->outputs);
  return {s.state.u, s.sleep ? s.sleep->share : 0};
}

void expect_within(const std::string& text, double bound) {
  const LastFrame awake = last_frame(text, {});
  const LastFrame asleep =
      last_frame(text, {"solver.sleep='" + std::to_string(1e3 * bound) + " mm'"});
  ASSERT_EQ(awake.u.size(), asleep.u.size());
  const double most = largest_difference(awake.u, asleep.u);
  std::printf("largest difference %.3f of the bound, share asleep %.2f\n", most / bound,
              asleep.share_asleep);
  EXPECT_LT(most, bound);
  EXPECT_GT(asleep.share_asleep, 0.1);
}

}  // namespace

TEST(Sleep, does_not_stop_what_a_grasper_has_let_go_of) {
  expect_within(lifted_bar, 0.5e-3);
}

// Few nodes are awake around the probe, and sleepers hold them where they are.
TEST(Sleep, does_not_stay_bent_when_what_bent_it_leaves) {
  expect_within(bent_bar, 0.5e-3);
}

// Half a second is less than a frame.
TEST(Sleep, does_not_stay_bent_at_a_frame_a_second) {
  expect_within(
      replaced(replaced(bent_bar, "frame_rate = 50", "frame_rate = 1"), "\"6 s\"", "\"20 s\""),
      0.5e-3);
}

// The time to wait is found anew then, of the body as it is without sleepers.
TEST(Sleep, waits_as_long_after_a_grasper_has_closed_on_nothing) {
  const auto run = built(
      replaced(bent_bar.substr(0, bent_bar.find("[[instrument]]")), "\"30 kPa\"", "\"0.3 kPa\"") +
          "[[instrument]]\nkind = \"grasper\"\npath = [\n"
          "{ time = 0, position = [0.02, 0, 0.3] },\n"
          "{ time = 4, position = [0.02, 0, 0.3], action = \"close\" } ]\n",
      {"solver.sleep='1 mm'", "solver.mass_damping='4 1/s'"});
  Simulation& s = *run->s;
  while (s.frame < 199) run_frame(s, run->outputs);
  EXPECT_EQ(s.sleep->share, 1);
  const double before = s.sleep->quiet_time;
  EXPECT_GT(before, 1);
  while (s.frame < 203) run_frame(s, run->outputs);
  EXPECT_EQ(s.log.events.size(), 1U);
  EXPECT_EQ(s.sleep->quiet_time, before);
  EXPECT_EQ(s.sleep->share, 1);
}

// omega = 3.516 h / L^2 sqrt(E / 12 rho): supports bear 60 times the weight as bending couples.
TEST(SettlingTime, of_a_slender_bar_along_any_axis_is_half_a_swing_or_somewhat_more) {
  for (const std::string size :
       {"\"300 mm\", \"10 mm\", \"10 mm\"", "\"10 mm\", \"300 mm\", \"10 mm\"",
        "\"10 mm\", \"10 mm\", \"300 mm\""}) {
    const std::size_t axis = size.starts_with("\"300") ? 0 : size.ends_with("300 mm\"") ? 2 : 1;
    std::string cells = "2, 2, 2", side = "x-";
    cells.replace(3 * axis, 1, "30");
    side[0] = static_cast<char>('x' + axis);
    const auto bar =
        built("[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\nlow = [0, 0, 0]\nhigh = [" +
              size + "]\ncells = [" + cells +
              "]\n[tissue.material]\nyoung_modulus = 30000\npoisson_ratio = 0.3\n"
              "density = 1000\n[solver]\nhexahedron = \"enhanced\"\n[[support]]\nregion = \"" +
              side + "\"\n");
    const double omega = 3.516 * 0.01 / (0.3 * 0.3) * std::sqrt(30000 / (12 * 1000.));
    const double found = settling_time(*bar->s) * omega / 3.14159;
    std::printf("%.3f of half a swing\n", found);
    EXPECT_GT(found, 0.95);
    EXPECT_LT(found, 1.4);
  }
}

TEST(SettlingTime, of_a_body_that_may_slide_is_that_of_where_it_is_held) {
  const std::string on_x = bent_bar, on_z = replaced(bent_bar, "\"x-\"", "\"z-\"\nfix = \"z\"");
  EXPECT_LT(settling_time(*built(on_z)->s), 0.2 * settling_time(*built(on_x)->s));
}

TEST(Sleep, waits_for_a_flap_that_is_slower_than_the_body_was) {
  expect_within(slow_flap, 1e-3);
}

}  // namespace trocar
