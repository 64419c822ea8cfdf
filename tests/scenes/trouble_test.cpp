// What a run does when the numbers go wrong, through the front door: it warns, rolls back and goes
// on with a smaller step, or ends with exit code 3 and keeps what it has.
#include <gtest/gtest.h>

#include <fstream>

#include "program.h"

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

// Takes hold of the bar's end and moves it down by 40 mm within `seconds`.
std::string jerk(const std::string& seconds) {
  return bar + R"([[instrument]]
kind = "grasper"
radius = "2 mm"
grip_radius = "8 mm"
path = [
  { time = 0, position = ["62 mm", "5 mm", "5 mm"], direction = [-1, 0, 0], forward = [0, 1, 0], action = "close" },
  { time = "0.1 s", position = ["62 mm", "5 mm", "5 mm"], direction = [-1, 0, 0], forward = [0, 1, 0] },
  { time = ")" +
         seconds + R"(", position = ["10 mm", "5 mm", "5 mm"], direction = [-1, 0, 0], forward = [0, 1, 0] },
]
)";
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

TEST(Trouble, hourglass_energy_above_5_per_cent_is_warned_of_once) {
  const std::string folder = test_folder("hourglass");
  ASSERT_EQ(run_text(bar, folder).exit_code, 0);
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_GT(summary["energies_J"]["largest_hourglass_share"], 0.05);
  EXPECT_TRUE(has_event(summary, "% of the stored energy: a finer mesh or more solver.hourglass"));
  EXPECT_EQ(summary["events"].size(), 1u);
}

}  // namespace
}  // namespace trocar
