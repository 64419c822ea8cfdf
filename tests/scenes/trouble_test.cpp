// What a run does when the numbers go wrong, through the front door: it warns, rolls back and goes
// on with a smaller step, or ends with exit code 3 and keeps what it has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "program.h"
#include "replaced.h"

namespace trocar {
namespace {

// A soft bar of one layer of one-point hexahedra that bends under its weight.
const std::string bar = R"(
[time]
duration = "0.5 s"
frame_rate = "30 Hz"
[tissue.shape]
kind = "box"
elements = "hex8"
low = [0, 0, 0]
high = ["60 mm", "10 mm", "10 mm"]
cells = [6, 1, 1]
[tissue.material]
model = "neo-hookean"
young_modulus = "10 kPa"
poisson_ratio = 0.45
density = "1000 kg/m^3"
[solver]
gravity = [0, 0, "-9.81 m/s^2"]
mass_damping = "5 1/s"
[[support]]
region = "x-"
fix = "xyz"
[[output]]
kind = "metrics"
file = "metrics.csv"
)";

// Takes hold of the bar's end, waits for .1 s and moves it along the bar to x within 20 ms.
std::string pushed_to(const std::string& x) {
  const std::string direction = R"(, direction = [-1, 0, 0], forward = [0, 1, 0])";
  const std::string held = R"(position = ["62 mm", "5 mm", "5 mm"])" + direction;
  return bar + R"([[instrument]]
kind = "grasper"
radius = "2 mm"
grip_radius = "8 mm"
path = [
  { time = 0, )" +
         held + R"(, action = "close" },
  { time = "0.1 s", )" +
         held + R"( },
  { time = "0.12 s", position = [")" +
         x + R"(", "5 mm", "5 mm"])" + direction + " },\n]\n";
}

Finished run_text(const std::string& scene, const std::string& folder) {
  const std::string file = folder + "/scene.toml";
  std::ofstream(file) << scene;
  return run_trocar({"run", file, "-q", "-o", folder}, folder);
}

bool has_event(const nlohmann::json& summary, const std::string& words) {
  for (const auto& event : summary["events"])
    if (event.get<std::string>().find(words) != std::string::npos) return true;
  return false;
}

// Whether the sentence about a failed frame has these words, and ends its place with a speed about
// this one [m/s].
bool tells_of(const Finished& run, const std::string& place, const std::string& who, double speed) {
  const std::string before_speed = who + ", which moves at ";
  const std::size_t at = run.err.find(before_speed);
  if (run.exit_code != 3 || at == std::string::npos || run.err.find(place) > at) return false;
  return std::abs(std::stod(run.err.substr(at + before_speed.size())) - speed) < 0.1 * speed;
}

TEST(Trouble, hourglass_energy_above_5_per_cent_is_warned_of_once) {
  const std::string folder = test_folder("hourglass");
  ASSERT_EQ(run_text(bar, folder).exit_code, 0);
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_GT(summary["energies_J"]["largest_hourglass_share"], 0.05);
  EXPECT_TRUE(has_event(summary, "% of the stored energy: the mesh is too coarse for"));
  EXPECT_EQ(summary["events"].size(), 1u);
}

TEST(Trouble, hourglass_energy_of_the_material_is_no_trouble) {
  const std::string folder = test_folder("enhanced");
  ASSERT_EQ(run_text(replaced(bar, "[solver]\n", "[solver]\nhexahedron = \"enhanced\"\n"), folder)
                .exit_code,
            0);
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_GT(summary["energies_J"]["largest_hourglass_share"], 0.05);
  EXPECT_EQ(summary["events"].size(), 0u);
}

TEST(Trouble, linear_material_beyond_small_strains_is_warned_of_once) {
  const auto summary_of = [](const std::string& modulus) {
    const std::string folder = test_folder("linear");
    std::string scene = replaced(bar, "neo-hookean", "linear");
    scene = replaced(scene, "10 kPa", modulus);
    EXPECT_EQ(run_text(scene, folder).exit_code, 0);
    return read_summary(folder);
  };
  // At rest the end is turned by 2 rho g L^3 / (E h^2), 24 degrees at 100 kPa and a quarter of one
  // at 10 MPa, in its first swing by up to twice as much; the range ends at 5.7 degrees.
  const nlohmann::json soft = summary_of("100 kPa");
  EXPECT_TRUE(has_event(soft, "the linear material is used beyond small strains and rotations"));
  EXPECT_EQ(std::count_if(soft["events"].begin(), soft["events"].end(),
                          [](const nlohmann::json& event) {
                            return event.get<std::string>().find("linear") != std::string::npos;
                          }),
            1);
  EXPECT_FALSE(has_event(summary_of("10 MPa"), "linear"));
}

// At 2.6 m/s the steps of the frame's beginning are too long for what happens within it.
TEST(Trouble, in_a_frame_is_answered_by_rolling_back_and_going_on_with_half_the_step) {
  const std::string folder = test_folder("rolled-back");
  ASSERT_EQ(run_text(pushed_to("10 mm"), folder).exit_code, 0);
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_EQ(summary["finished"], true);
  EXPECT_EQ(summary["frames"], 15);
  EXPECT_GE(summary["roll_backs"], 1);
  EXPECT_TRUE(has_event(summary, "s: rolled back: "));
  EXPECT_TRUE(has_event(summary, "step scale now 0.5"));
}

// The blade's flat side goes 5 mm a frame through cells of 2 mm.
TEST(Trouble, that_is_not_finite_has_a_reason_and_a_place) {
  const std::string folder = test_folder("flat-side-first");
  const Finished run = run_text(R"([time]
duration = "0.2 s"
frame_rate = "60 Hz"
[tissue.shape]
kind = "box"
elements = "tet4-kuhn"
low = ["-20 mm", "-20 mm", 0]
high = ["20 mm", "20 mm", "4 mm"]
cells = [20, 20, 2]
[tissue.material]
young_modulus = "5 kPa"
[solver]
mass_damping = 20
[[support]]
region = "z-"
[[instrument]]
kind = "scalpel"
blade_length = "20 mm"
path = [
  { time = "0.05 s", position = [0, "-32 mm", "-5 mm"], forward = [1, 0, 0] },
  { time = "0.26 s", position = [0, "32 mm", "-5 mm"], forward = [1, 0, 0] },
]
)",
                                folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_TRUE(has_event(summary, "rolled back: displacements grow beyond all numbers from step "));
  EXPECT_TRUE(has_event(summary, " on, as element "));
  EXPECT_TRUE(has_event(summary, " m from \"scalpel\", which moves at 0."));
  EXPECT_FALSE(has_event(summary, "non-finite")) << summary["events"];
}

// Through the support and 40 cm beyond.
TEST(Trouble, that_smaller_steps_do_not_cure_ends_the_run_with_3_and_keeps_what_it_has) {
  const std::string folder = test_folder("given-up");
  const Finished run = run_text(pushed_to("-400 mm"), folder);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("in the frame after 0.1 s: "), std::string::npos) << run.err;
  EXPECT_NE(
      run.err.find(
          "roll-backs with smaller steps did not help: a slower or shorter path of \"grasper\""),
      std::string::npos)
      << run.err;
  EXPECT_TRUE(tells_of(run, " is inverted (det F = ", " m from \"grasper\"", 14)) << run.err;
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_EQ(summary["finished"], false);
  EXPECT_EQ(summary["frames"], 3);
  const std::string metrics = read_text(folder + "/metrics.csv");
  EXPECT_EQ(std::count(metrics.begin(), metrics.end(), '\n'), 4);  // head, 3 frames
}

// Frames of a tenth of a millisecond, in which no machine steps, watches and tells of 24,000
// elements.
TEST(Trouble, a_missed_deadline_that_ends_the_run_does_so_with_3_and_keeps_what_it_has) {
  const std::string folder = test_folder("missed"), fast = test_folder("not-missed");
  const std::string text = replaced(bar, "cells = [6, 1, 1]", "cells = [60, 20, 20]");
  const std::vector<std::string> words = {
      "run",   folder + "/scene.toml", "-q", "--set", "time.frame_rate='10 kHz'",
      "--set", "time.pace=real-time"};
  std::ofstream(folder + "/scene.toml") << text;
  const auto run = [&](const std::string& to, std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    more.insert(more.end(), {"-o", to});
    return run_trocar(more, folder);
  };
  const Finished stopped = run(folder, {"--set", "time.overrun=stop"});
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_NE(stopped.err.find(" ms after its deadline"), std::string::npos) << stopped.err;
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_EQ(summary["finished"], false);
  EXPECT_EQ(summary["deadlines_missed"], 1);
  const int n = summary["frames"];
  EXPECT_LT(n, 10);
  const std::string metrics = read_text(folder + "/metrics.csv");
  EXPECT_EQ(std::count(metrics.begin(), metrics.end(), '\n'), n + 1);

  const std::string end = "time.duration=" + std::to_string(1e-4 * (n + 2));
  EXPECT_EQ(run(folder, {"--resume", "--set", end}).exit_code, 0);
  EXPECT_EQ(run(fast, {"--set", end, "--set", "time.pace=fast"}).exit_code, 0);
  EXPECT_EQ(read_summary(folder)["state_digest"], read_summary(fast)["state_digest"]);
}

// The whole bar's length, again and again.
TEST(Trouble, names_the_support_that_tears_the_tissue) {
  const Finished run = run_text(bar + R"([[support]]
region = "x+"
path = [
  { time = 0, displacement = [0, 0, 0] },
  { time = "0.1 s", displacement = ["-8 m", 0, 0] },
]
)",
                                test_folder("torn-by-support"));
  EXPECT_TRUE(tells_of(run, " at (", " m from a node held by the support of \"x+\"", 62))
      << run.err;
}

// Of a material that yields to compression.
TEST(Trouble, names_the_instrument_that_crushes_the_tissue) {
  const Finished run = run_text(replaced(bar, "neo-hookean", "st-venant-kirchhoff") + R"([[region]]
name = "below"
low = [-1, -1, -1]
high = ["1 m", "1 m", "1 mm"]
[[support]]
region = "below"
[[instrument]]
kind = "probe"
name = "thumb"
radius = "30 mm"
path = [
  { time = 0, position = ["30 mm", "5 mm", "45 mm"] },
  { time = "0.4 s", position = ["30 mm", "5 mm", "-3 mm"] },
]
)",
                                test_folder("crushed-by-probe"));
  EXPECT_TRUE(tells_of(run, " at (", " m from \"thumb\"", 0.08)) << run.err;
  EXPECT_NE(run.err.find("did not help: a material for large strains such as neo-hookean "
                         "(st-venant-kirchhoff softens as it is pressed together"),
            std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace trocar
