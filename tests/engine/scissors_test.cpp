// What scissors divide when they close.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine_scene.h"
#include "engine_started.h"
#include "larger_or_nan.h"
#include "mesh/connected_nodes.h"
#include "replaced.h"

namespace trocar {
namespace {

// A body 40 mm long in y, 5 mm high and `width` wide, held at both ends. Scissors of 20 mm come
// from above, their pivot at z = 17 mm, and close at 0.4 s in the plane y = 1 mm.
std::string snip_text(double width, const std::string& action) {
  const std::string half = std::to_string(width / 2);
  const std::string pose = "direction = [0, 0, -1], forward = [1, 0, 0]";
  return "[time]\nduration = \"1 s\"\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\n"
         "low = [-" +
         half + ", -0.02, 0]\nhigh = [" + half + ", 0.02, 0.005]\ncells = [" +
         std::to_string(static_cast<int>(width / 1.25e-3)) +
         ", 32, 4]\nelements = \"tet4-kuhn\"\n"
         "[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\ndensity = 1000\n"
         "[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n[checkpoint]\nevery = 0\n"
         "[[instrument]]\nkind = \"scissors\"\nblade_length = 0.02\npath = [\n"
         "{ time = 0, position = [0, 0.001, 0.03], " +
         pose +
         " },\n"
         "{ time = 0.15, position = [0, 0.001, -0.003], " +
         pose +
         " },\n"
         "{ time = 0.4, position = [0, 0.001, -0.003], " +
         pose + ", action = \"" + action + "\" },\n{ time = 0.6, position = [0, 0.001, -0.003], " +
         pose + ", action = \"open\" } ]\n";
}

std::unique_ptr<Started> run_to(double time, const std::string& text, double frame_rate = 100) {
  auto started = built(text);
  while (static_cast<double>(started->s->frame) < frame_rate * time)
    run_frame(*started->s, started->outputs);
  return started;
}

TEST(Scissors, divide_a_strip_that_lies_between_their_blades) {
  const auto started = run_to(0.45, snip_text(0.005, "close"));
  const Simulation& s = *started->s;
  EXPECT_EQ(s.n_pieces, 2);
  ASSERT_EQ(s.cuts.at(0).strokes.size(), 1U);
  const CutRecord& record = s.cuts[0].strokes[0];
  EXPECT_FALSE(s.cuts[0].is_in_stroke);
  EXPECT_GE(record.start, 0.2);  // they begin to close
  EXPECT_LE(record.end, 0.41);
  EXPECT_EQ(record.n_elements_added, 0);
  // The plane y = 1 mm leaves 21 / 40 of the mass on one side, to half an element of 1.25 mm.
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  double low = 0, all = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    all += s.mass[i];
    if (piece[i] == piece[0]) low += s.mass[i];
  }
  EXPECT_NEAR(all, 1000 * 0.005 * 0.04 * 0.005, 1e-12);
  EXPECT_NEAR(low / all, 21.0 / 40, 0.5 * 1.25 / 40);
}

// The cut's resistance has bent the strip down by two edges. As it comes apart the lips spring
// back, behind the jaws, and are pushed aside: where the edge was beside them is no way of the
// edge.
TEST(Scissors, leave_lips_alone_that_spring_back_from_their_edge) {
  const std::string pose =
      "position = [0.02184, 0.006, -0.01], direction = [0, 0, -1], "
      "forward = [0, 1, 0]";
  const auto started = run_to(
      0.45,
      "[time]\nduration = 2\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\n"
      "low = [0, 0, 0]\nhigh = [0.06, 0.012, 0.006]\ncells = [20, 4, 2]\n"
      "elements = \"tet4-kuhn\"\n[tissue.material]\nyoung_modulus = 60e3\npoisson_ratio = 0.4\n"
      "[solver]\nmass_damping = 15\ngravity = [0, 0, 0]\n[cutting]\nresistance = 12\n"
      "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n[checkpoint]\nevery = 0\n"
      "[[instrument]]\nkind = \"scissors\"\nradius = 1.5e-3\nblade_length = 0.04\npath = [\n"
      "{ time = 0, " +
          pose + ", action = \"open\" },\n{ time = 0.1, " + pose +
          " },\n"
          "{ time = 0.4, " +
          pose + ", action = \"close\" } ]\n",
      60);
  const Simulation& s = *started->s;
  EXPECT_EQ(s.n_pieces, 2);
  const CutRecord& record = s.cuts.at(0).strokes.at(0);
  EXPECT_EQ(record.figures.n_refused, 0);
  EXPECT_LT(record.figures.largest_deviation, 0.5 * record.figures.mean_edge);
}

TEST(Scissors, cut_a_slit_into_a_plate_that_is_wider_than_they_open) {
  const auto started = run_to(0.45, snip_text(0.03, "close"));
  const Simulation& s = *started->s;
  EXPECT_EQ(s.n_pieces, 1);
  ASSERT_EQ(s.cuts.at(0).strokes.size(), 1U);
  EXPECT_GT(s.cuts[0].strokes[0].figures.n_opened_facets, 0);
  // The blades are at most 17 mm * tan(0.3) from the middle; an element may be taken in whole.
  for (std::size_t i =
           s.mesh.X.size() - static_cast<std::size_t>(s.cuts[0].strokes[0].figures.n_duplicated);
       i < s.mesh.X.size(); ++i)
    EXPECT_LT(std::abs(s.mesh.X[i].x()), 0.0053 + 1.25e-3);
}

bool is_of_tissue_beside(const std::string& event) {
  return contains(event, "beside its open jaws");
}

// The plate is told of once a closing, also where it is so soft that it swings on the blades; the
// strip that lies between these not at all.
TEST(Scissors, tell_of_tissue_that_lies_beside_their_jaws) {
  for (const double width : {0.03, 0.005})
    for (const std::string resistance : {"0", "20"}) {
      const auto started =
          run_to(0.45, snip_text(width, "close") + "[cutting]\nresistance = " + resistance + "\n");
      EXPECT_EQ(std::ranges::count_if(started->s->log.events, is_of_tissue_beside),
                width > 0.02 ? 1 : 0)
          << resistance;
    }
}

// A strip hardly wider than they open is beside them for a moment, within a frame if that is long.
TEST(Scissors, tell_of_tissue_beside_their_jaws_at_any_frame_rate) {
  for (const int frame_rate : {30, 60, 120}) {
    const auto started = run_to(0.45,
                                replaced(snip_text(0.008, "close"), "frame_rate = 100",
                                         "frame_rate = " + std::to_string(frame_rate)),
                                frame_rate);
    EXPECT_EQ(started->s->n_pieces, 1);
    EXPECT_EQ(std::ranges::count_if(started->s->log.events, is_of_tissue_beside), 1) << frame_rate;
  }
}

TEST(Scissors, that_only_open_cut_nothing) {
  const auto started = run_to(0.65, snip_text(0.005, "none"));
  EXPECT_EQ(started->s->n_pieces, 1);
  EXPECT_TRUE(started->s->cuts.at(0).strokes.empty());
}

// Pushed down until their blades cross 2 mm below the strip's top: this stands in the crotch, 3 mm
// above where it would pass on to the shaft.
TEST(Scissors, push_what_stands_in_the_crotch_of_their_open_blades) {
  std::string text = snip_text(0.005, "none");
  for (std::size_t at = text.find("-0.003]"); at != std::string::npos; at = text.find("-0.003]"))
    text.replace(at, 7, "-0.014]");
  const auto started = run_to(0.3, text);
  const Simulation& s = *started->s;
  const double crossing = -0.014 + 0.02 - 0.15 * 0.02;
  double top = 0;  // beneath the crotch
  for (const std::int32_t i : s.surface.node) {
    const Vec3& x = s.view.x[i];
    if (std::abs(x.y() - 0.001) < 0.4e-3 && std::abs(x.x()) < 0.5e-3)
      top = larger_or_nan(top, x.z());
  }
  // As of a beam with both ends clamped, 192 E I w / L^3; tissue that is pressed in yields more.
  const double force = 192 * 6000 * (std::pow(0.005, 4) / 12) * 0.002 / std::pow(0.04, 3);
  EXPECT_GT(s.log.rows.back().tools[0].force.z(), 0.5 * force);
  EXPECT_LT(top, crossing + 0.1e-3);
}

// A line of closings through a block that bears against them. The second one leaves a bridge a
// long way behind the jaws' tips.
TEST(Scissors, tell_of_bridges_that_they_leave_behind) {
  const auto at = [](double time, double y, const std::string& action) {
    return "{ time = " + std::to_string(time) + ", position = [" +
           std::to_string(0.0325 - 0.137e-3 * y) + ", " + std::to_string(1e-3 * y) +
           ", 0.003], direction = [-0.137, 1, 0], forward = [0, 0, 1]" + action + " },\n";
  };
  std::string path = at(0.02, -12, "");
  for (int k = 0; k < 4; ++k)
    path += at(0.12 + 0.42 * k, 10 + 9 * k, "") +
            at(0.32 + 0.42 * k, 10 + 9 * k, ", action = \"close\"") +
            at(0.44 + 0.42 * k, 10 + 9 * k, ", action = \"open\"");
  const auto started = run_to(
      1.75,
      "[time]\nduration = 2\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\nhigh = [0.06, 0.03, 0.006]\ncells = [24, 12, 2]\n[tissue.material]\n"
      "young_modulus = 20e3\npoisson_ratio = 0.4\n[solver]\nmass_damping = 20\n[cutting]\n"
      "resistance = 10\n[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n"
      "[[instrument]]\nkind = \"scissors\"\nradius = 0.001\nblade_length = 0.05\npath = [\n" +
          path + "]\n",
      60);
  const auto is_of_bridge = [](const std::string& event) {
    return contains(event, "scissors leaves tissue joined in ");
  };
  EXPECT_EQ(started->s->n_pieces, 1);
  EXPECT_EQ(std::ranges::count_if(started->s->log.events, is_of_bridge), 1);
}

}  // namespace
}  // namespace trocar
