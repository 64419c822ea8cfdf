#include "engine/swept_area.h"

#include <gtest/gtest.h>

#include "engine_started.h"
#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

// Unit cube of four cells a side, cut in the plane x = 0.5 below z = 0.5.
Mesh cube_with_slit() {
  Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {4, 4, 4}, BoxElements::tet4_kuhn);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 4; ++f) {
      const auto corner = facet_corners(ElementType::tet4, f);
      const bool is_in_slit = std::all_of(corner.begin(), corner.begin() + 3, [&](int a) {
        const Vec3& X = mesh.X[mesh.corners(e)[a]];
        return std::abs(X.x() - 0.5) < 1e-12 && X.z() < 0.5 + 1e-12;
      });
      if (is_in_slit) mesh.cut_facets[e] |= static_cast<std::uint8_t>(1U << f);
    }
  return mesh;
}

// Of a blade that went through all of the cube at x.
std::vector<SweptPlace> places_at(double x) {
  std::vector<SweptPlace> places;
  for (int j = 0; j < 10; ++j)
    for (int k = 0; k < 10; ++k)
      places.push_back({{x, 0.1 * j + 0.03, 0.1 * k + 0.03}, Vec3::UnitX(), 0.01});
  return places;
}

TEST(SweptArea, is_parted_where_a_cut_lies_within_three_quarters_of_an_edge) {
  const Mesh mesh = cube_with_slit();
  constexpr double edge = 0.25;
  for (const double aside : {0.0, 0.1, -0.18}) {
    const SweptArea area = measure_swept(mesh, edge, places_at(0.5 + aside));
    EXPECT_NEAR(area.whole, 1, 1e-12);
    EXPECT_NEAR(area.parted, 0.5, 1e-12) << aside;
  }
  EXPECT_EQ(measure_swept(mesh, edge, places_at(0.5 + 0.2)).parted, 0);
  EXPECT_EQ(measure_swept(mesh, edge, {}).whole, 0);
}

// A block of 60 x 40 x 30 mm with cells of 5 mm, held at its ends, and a blade that goes along it
// at these depths, one after the other.
std::unique_ptr<Started> cut_at_depths(const std::string& elements,
                                       const std::vector<double>& depths) {
  std::string path;
  double t = 0;
  for (const double depth : depths) {
    const std::string z = std::to_string(0.03 - depth);
    for (const std::string x : {"-0.045", "0.045"}) {
      path += "{ time = " + std::to_string(t) + ", position = [" + x + ", 0.001, " + z +
              "], stop = true },\n";
      t += 0.5;
    }
    path += "{ time = " + std::to_string(t - 0.2) + ", position = [0.045, 0.001, 0.08] },\n";
    path += "{ time = " + std::to_string(t - 0.1) + ", position = [-0.045, 0.001, 0.08] },\n";
  }
  auto started = built("[time]\nduration = " + std::to_string(t) + "\nframe_rate = 60\n" +
                       "[tissue.shape]\nkind = \"box\"\nelements = \"" + elements +
                       "\"\nlow = [-0.03, -0.02, 0]\nhigh = [0.03, 0.02, 0.03]\n"
                       "cells = [12, 8, 6]\n[tissue.material]\nyoung_modulus = 6e4\n"
                       "[solver]\nmass_damping = 30\n[contact]\nfriction = 0\n"
                       "[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n"
                       "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.06\nlength = 0.15\n"
                       "path = [\n" +
                       path + "]\n");
  Simulation& s = *started->s;
  while (s.frame < s.scene.time.n_frames()) run_frame(s, started->outputs);
  return started;
}

bool has_told_little(const Simulation& s) {
  return std::ranges::any_of(
      s.log.events, [](const std::string& event) { return contains(event, "has parted"); });
}

// Two facets of some 300 mm^2 opened without a word.
TEST(SweptArea, of_a_cut_one_element_deep_that_parts_next_to_nothing_is_told) {
  const auto started = cut_at_depths("tet4-five", {0.005});
  const CutRecord& stroke = started->s->cuts[0].strokes.at(0);
  EXPECT_GT(stroke.figures.n_opened_facets, 0);
  EXPECT_NEAR(stroke.swept_area, 0.06 * 0.005, 0.1 * 0.06 * 0.005);
  EXPECT_LT(stroke.parted_area, 0.3 * stroke.swept_area);
  EXPECT_TRUE(has_told_little(*started->s));
}

TEST(SweptArea, of_deeper_cuts_is_parted_for_the_most_and_nothing_is_told) {
  for (const std::string elements : {"tet4-five", "tet4-kuhn", "hex8"}) {
    const auto started = cut_at_depths(elements, {0.0085});
    const CutRecord& stroke = started->s->cuts[0].strokes.at(0);
    EXPECT_NEAR(stroke.swept_area, 0.06 * 0.0085, 0.1 * 0.06 * 0.0085) << elements;
    EXPECT_GT(stroke.parted_area, 0.5 * stroke.swept_area) << elements;
    EXPECT_FALSE(has_told_little(*started->s)) << elements;
  }
}

// A soft block swings under its weight past a blade that rests in it. While each swing counted, it
// had "parted 1.11 of the 8.4 cm^2 that its edge went through".
TEST(SweptArea, of_a_blade_at_rest_does_not_grow) {
  const auto started = built(
      "[time]\nduration = 3\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\nlow = [-0.03, -0.02, 0]\nhigh = [0.03, 0.02, 0.03]\ncells = [12, 8, 6]\n"
      "[tissue.material]\nyoung_modulus = 1000\n[solver]\ngravity = [0, 0, -9.81]\nmass_damping = "
      "0.2\n[contact]\nfriction = 0\n[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n"
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.06\nlength = 0.15\npath = [\n"
      "{ time = 0, position = [-0.045, 0.001, 0.0215], stop = true },\n"
      "{ time = 0.4, position = [-0.005, 0.001, 0.0215], stop = true },\n"
      "{ time = 2.7, position = [-0.005, 0.001, 0.0215], stop = true },\n"
      "{ time = 2.9, position = [-0.005, 0.001, 0.08], stop = true }]\n");
  Simulation& s = *started->s;
  while (s.frame < s.scene.time.n_frames()) run_frame(s, started->outputs);
  double area = 0;
  for (const CutRecord& stroke : s.cuts[0].strokes) area += stroke.swept_area;
  // Some 25 mm of way, 8.5 mm deep in the block at rest, from which it hangs down.
  EXPECT_GT(area, 0.025 * 0.001);
  EXPECT_LT(area, 0.025 * 0.0085);
  EXPECT_FALSE(has_told_little(s));
}

TEST(SweptArea, counts_older_wounds_as_parted) {
  const auto started = cut_at_depths("tet4-kuhn", {0.02, 0.025});
  const auto& strokes = started->s->cuts[0].strokes;
  ASSERT_EQ(strokes.size(), 2u);
  EXPECT_GT(strokes[1].figures.n_opened_facets, 0);
  EXPECT_GT(strokes[1].parted_area, 0.6 * strokes[1].swept_area);
  EXPECT_FALSE(has_told_little(*started->s));
}

}  // namespace
}  // namespace trocar
