// What resists a blade: tissue that it parts, and no other; its work is that of the area.
#include "engine/cut_front.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine_started.h"
#include "replaced.h"

namespace trocar {
namespace {

constexpr double resistance = 20;

struct Key {
  double time, x, z;
};

// A body held at both sides in y that a blade of 40 mm goes through in the plane y = 0.3 mm.
std::string pass_text(const std::string& shape, int frame_rate, const std::vector<Key>& keys) {
  std::string text =
      "[time]\nduration = 9\nframe_rate = " + std::to_string(frame_rate) + "\n[tissue.shape]\n" +
      shape +
      "[tissue.material]\nyoung_modulus = 20000\n[solver]\nmass_damping = 20\n"
      "[contact]\nfriction = 0\n[cutting]\nresistance = " +
      std::to_string(resistance) +
      "\n[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n[[instrument]]\n"
      "kind = \"scalpel\"\nblade_length = 0.04\npath = [\n";
  for (const Key& key : keys)
    text += "{ time = " + std::to_string(key.time) + ", position = [" + std::to_string(key.x) +
            ", 0.0003, " + std::to_string(key.z) + "] },\n";
  return text + "]\n";
}

// Work of the blade between the times [s] as parts of the resistance times an area. [m^2]
std::vector<double> works(const std::string& text, double area, const std::vector<double>& times) {
  const auto started = built(text);
  Simulation& s = *started->s;
  std::vector<double> parts(times.size(), 0.0);
  Vec3 before = s.tools[0].path.at(0).translation;
  for (std::size_t k = 0; k < times.size(); ++k)
    while (static_cast<double>(s.frame) < times[k] * s.scene.time.frame_rate - 0.5) {
      run_frame(s, started->outputs);
      const ToolRow& blade = s.log.rows.back().tools[0];
      parts[k] -= blade.force.dot(blade.position - before) / (resistance * area);
      before = blade.position;
    }
  return parts;
}

// 30 x 20 x 12 mm; a blade below its bottom parts it.
constexpr double way = 0.03, depth = 0.012, below = -0.004, above = 0.03;
std::string block_shape(const std::string& elements) {
  return "kind = \"box\"\nelements = \"" + elements +
         "\"\nlow = [-0.015, -0.01, 0]\nhigh = [0.015, 0.01, 0.012]\ncells = [12, 8, 5]\n";
}

// The block bulges by some 2 % where it is cut, and takes with it what its ends give way, 3 %.
constexpr double tolerance = 0.05;

TEST(CutFront, is_nowhere_in_the_slit_that_the_blade_has_cut) {
  for (const std::string elements : {"tet4-kuhn", "tet4-five", "hex8"}) {
    const std::vector<double> work = works(pass_text(block_shape(elements), 60,
                                                     {{0.1, -0.03, below},
                                                      {0.6, 0.03, below},
                                                      {0.7, 0.03, above},
                                                      {0.8, -0.03, above},
                                                      {0.9, -0.03, below},
                                                      {1.4, 0.03, below},
                                                      {1.9, -0.03, below}}),
                                           way * depth, {0.65, 1.45, 1.95});
    EXPECT_NEAR(work[0], 1, tolerance) << elements;
    EXPECT_NEAR(work[1], 0, 0.02) << elements;
    EXPECT_NEAR(work[2], 0, 0.02) << elements << ", backwards";
  }
}

// The slit ends up to an element of 2.5 mm behind where the blade was.
TEST(CutFront, is_where_a_slit_ends_that_the_blade_goes_on_from) {
  const std::vector<double> work = works(pass_text(block_shape("tet4-kuhn"), 60,
                                                   {{0.1, -0.03, below},
                                                    {0.45, 0, below},
                                                    {0.55, 0, above},
                                                    {0.65, -0.03, above},
                                                    {0.75, -0.03, below},
                                                    {1.25, 0.03, below}}),
                                         way * depth, {0.6, 1.3});
  EXPECT_NEAR(work[0], 0.5, tolerance);
  EXPECT_NEAR(work[1], 0.5, tolerance + 0.0025 / way);
}

// By less than what it has swept ahead of its slit, and into that; then on. Out of the tissue in
// its slit it begins anew where that ends.
TEST(CutFront, is_not_met_by_a_blade_that_goes_back) {
  for (const double back : {0.001, 0.01}) {
    const std::vector<double> work = works(pass_text(block_shape("tet4-kuhn"), 60,
                                                     {{0.1, -0.03, below},
                                                      {0.4, 0, below},
                                                      {0.6, -back, below},
                                                      {0.8, 0, below},
                                                      {1.2, 0.03, below}}),
                                           way * depth, {0.4, 0.6, 1.25});
    EXPECT_NEAR(work[0], 0.5, tolerance) << back;
    EXPECT_NEAR(work[1], 0, 0.04) << back;
    const double is_out = back > 0.0025 ? 1 : 0.5;
    EXPECT_NEAR(work[2], 0.5, tolerance + is_out * 0.0025 / way) << back;
  }
}

TEST(CutFront, of_a_plane_body_is_the_tip) {
  const std::string plate = "kind = \"rectangle\"\nhigh = [0.03, 0.02, 0]\ncells = [13, 9, 1]\n";
  std::string text = pass_text(plate, 60, {{0.1, -0.015, 0}, {0.6, 0.045, 0}, {1.1, -0.015, 0}});
  for (std::size_t at = text.find("0.0003"); at != std::string::npos; at = text.find("0.0003"))
    text.replace(at, 6, "0.0103");
  const std::vector<double> work = works(text, way * 0.001, {0.6, 1.15});
  EXPECT_NEAR(work[0], 1, tolerance);
  EXPECT_NEAR(work[1], 0, 0.02);
}

std::string stiffer(const std::string& text) {
  return replaced(text, "young_modulus = 20000", "young_modulus = 80000");
}

// From a column of 10 mm within one frame to a dozen frames in it, a quarter of a frame later each
// time. The column, stiffer than the blocks, still goes along by some 4 % of the work.
TEST(CutFront, does_the_work_of_the_area_at_any_frame_rate_and_phase) {
  const std::string column =
      "kind = \"box\"\nelements = \"tet4-kuhn\"\nlow = [-0.005, -0.01, 0]\n"
      "high = [0.005, 0.01, 0.012]\ncells = [4, 8, 5]\n";
  for (const auto& [rate, seconds] : {std::pair{30, 0.05}, {30, 0.12}, {120, 0.6}})
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double begin = 0.1 + 0.25 * quarter / rate;
      const std::vector<double> work = works(
          stiffer(pass_text(column, rate, {{begin, -0.03, below}, {begin + seconds, 0.03, below}})),
          0.01 * depth, {0.1 + seconds + 0.1});
      EXPECT_NEAR(work[0], 1, 0.1) << rate << " " << seconds << " " << quarter;
    }
}

// Down along its edge and up again.
TEST(CutFront, is_nowhere_along_an_edge_that_moves_along_itself) {
  const std::vector<double> work = works(
      pass_text(block_shape("tet4-kuhn"), 60, {{0.1, 0, 0.03}, {0.3, 0, 0.002}, {0.5, 0, 0.03}}),
      way * depth, {0.55});
  EXPECT_NEAR(work[0], 0, 1e-12);
}

}  // namespace
}  // namespace trocar
