// Instruments and tissue that go far within a frame: what they meet must not depend on how often
// pairs are looked for.
#include <gtest/gtest.h>

#include <string>

#include "engine_started.h"

namespace trocar {
namespace {

// Force on the first instrument along z at the end. [N]
double force_after(double seconds, int frame_rate, const std::string& scene) {
  const auto started =
      built("[time]\nduration = 10\nframe_rate = " + std::to_string(frame_rate) + "\n" + scene);
  for (int frame = 0; frame < seconds * frame_rate; ++frame)
    run_frame(*started->s, started->outputs);
  return started->s->log.rows.back().tools[0].force.z();
}

// least: force at 240 Hz at the least [N].
void expect_same_at_both_rates(const char* what, double seconds, double least,
                               const std::string& scene) {
  const double often = force_after(seconds, 240, scene), seldom = force_after(seconds, 30, scene);
  std::printf("%s: %.4f N at 240 Hz, %.4f N at 30 Hz\n", what, often, seldom);
  ASSERT_GT(often, least);
  EXPECT_NEAR(seldom, often, 0.02 * often);
}

// A ribbon, held at both ends, before a rod of 150 mm that turns by 70 degrees about its tip,
// 120 mm away.
const std::string lever = R"([tissue.shape]
kind = "box"
low = [0.105, -0.02, -0.002]
high = [0.135, 0.02, 0.002]
cells = [10, 14, 2]
elements = "hex8"
[tissue.material]
young_modulus = 20000
[solver]
mass_damping = 60
[contact]
friction = 0
[[support]]
region = "y-"
[[support]]
region = "y+"
[[instrument]]
kind = "probe"
radius = 0.003
length = 0.15
path = [
  { time = 0, position = [0, 0, 0], direction = [-0.5, 0, -0.866], forward = [0, 1, 0] },
  { time = 0.3, position = [0, 0, 0], direction = [-0.985, 0, 0.1736], forward = [0, 1, 0] } ]
)";

// With the travel of a point 20 mm above the tip, the shaft passed the ribbon at 30 Hz.
TEST(ContactReach, is_that_of_the_far_end_of_a_shaft) {
  expect_same_at_both_rates("lever", 0.6, 0.1, lever);
}

// A plate whose supports at two sides take it upwards by 20 mm in 60 ms, against a ball 3 mm above.
const std::string lifted_plate = R"([tissue.shape]
kind = "box"
low = [-0.02, -0.02, -0.004]
high = [0.02, 0.02, 0]
cells = [8, 8, 2]
elements = "tet4-kuhn"
[tissue.material]
young_modulus = 40000
[solver]
mass_damping = 60
[[support]]
region = "y-"
path = [{ time = 0.1, displacement = [0, 0, 0] }, { time = 0.16, displacement = [0, 0, 0.02] }]
[[support]]
region = "y+"
path = [{ time = 0.1, displacement = [0, 0, 0] }, { time = 0.16, displacement = [0, 0, 0.02] }]
[[instrument]]
kind = "probe"
radius = 0.004
path = [{ time = 0, position = [0, 0, 0.003] }]
)";

// With the speed at the frame's beginning alone, the plate passed the ball at 30 Hz.
TEST(ContactReach, is_that_of_what_supports_take_along) {
  expect_same_at_both_rates("lifted plate", 0.5, 0.5, lifted_plate);
}

}  // namespace
}  // namespace trocar
