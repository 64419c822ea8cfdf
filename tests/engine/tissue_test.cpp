#include "engine/tissue.h"

#include <gtest/gtest.h>

#include "engine_started.h"

namespace trocar {
namespace {

// A block of 4^3 cells, 40 mm wide, with regions of other stuff.
std::string block_with(const std::string& regions) {
  return "[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\nhigh = [0.04, 0.04, 0.04]\n"
         "cells = [4, 4, 4]\n" +
         regions;
}

const std::string tumour =
    "[[region]]\nname = \"tumour\"\nlow = [0.01, 0.01, 0.01]\nhigh = [0.03, 0.03, 0.03]\n";
const std::string stiff =
    "[[tissue.region_material]]\nregion = \"tumour\"\nmaterial = {young_modulus = 3e4}\n";

std::int64_t n_in(const Mesh& mesh, const std::string& region) {
  const auto number = std::ranges::find(mesh.region_name, region) - mesh.region_name.begin();
  return std::ranges::count(mesh.element_region, static_cast<std::int32_t>(number));
}

TEST(Tissue, elements_in_a_box_of_the_scene_are_of_another_material) {
  const auto started = built(block_with(tumour + stiff));
  const Simulation& s = *started->s;
  EXPECT_EQ(n_in(s.mesh, "tumour"), 8);
  for (std::int32_t e = 0; e < s.mesh.n_elements(); ++e) {
    const Vec3 c = element_centre(s.mesh, e);
    const bool is_inside = (c.array() > 0.01).all() && (c.array() < 0.03).all();
    EXPECT_EQ(s.materials[s.mesh.element_region[e]].young_modulus, is_inside ? 3e4 : 3e3);
  }
}

// The middles of the 8 cells lie 8.7 mm from its centre, its nodes 10 mm at most along an axis.
TEST(Tissue, ellipsoids_hold_what_is_within_their_half_axes) {
  const auto n_in_ball = [&](const std::string& low, const std::string& high) {
    const auto started =
        built(block_with("[[region]]\nname = \"tumour\"\nshape = \"ellipsoid\"\nlow = " + low +
                         "\nhigh = " + high + "\n" + stiff));
    return n_in(started->s->mesh, "tumour");
  };
  EXPECT_EQ(n_in_ball("[0.0113, 0.0113, 0.0113]", "[0.0287, 0.0287, 0.0287]"), 8);
  // Along x alone: (5 / 30)^2 + 2 (5 / 7.4)^2 = 0.94 and (15 / 30)^2 + 2 (5 / 7.4)^2 = 1.16.
  EXPECT_EQ(n_in_ball("[-0.01, 0.0126, 0.0126]", "[0.05, 0.0274, 0.0274]"), 8);
  EXPECT_EQ(n_in_ball("[-0.04, 0.0126, 0.0126]", "[0.08, 0.0274, 0.0274]"), 16);
}

// Stiff, soft and stiff again: the last one counts where they overlap.
TEST(Tissue, the_last_of_materials_that_name_a_region_counts) {
  const std::string other =
      "[[region]]\nname = \"rest\"\nlow = [0, 0, 0]\nhigh = [0.04, 0.04, 0.04]\n"
      "[[tissue.region_material]]\nregion = \"rest\"\nmaterial = {young_modulus = 1e3}\n";
  const auto covered = built(block_with(tumour + stiff + other));
  EXPECT_EQ(n_in(covered->s->mesh, "tumour"), 0);
  EXPECT_EQ(n_in(covered->s->mesh, "rest"), 64);
  const auto again = built(block_with(tumour + stiff + other + stiff));
  EXPECT_EQ(n_in(again->s->mesh, "tumour"), 8);
  EXPECT_EQ(n_in(again->s->mesh, "rest"), 56);
}

TEST(Tissue, a_colour_that_a_region_leaves_out_is_the_tissue_s) {
  const auto started = built(block_with("[tissue.look]\ncut_colour = [0.1, 0.2, 0.3]\n" + tumour +
                                        stiff + "look = {colour = [0.5, 0.5, 0.5]}\n"));
  const auto& look = started->s->scene.tissue.region_materials[0].look;
  ASSERT_TRUE(look);
  EXPECT_EQ(look->colour, Vec3(0.5, 0.5, 0.5));
  EXPECT_EQ(look->cut_colour, Vec3(0.1, 0.2, 0.3));
}

TEST(Tissue, a_region_without_an_element_is_refused) {
  const std::string text = error_of([&] {
    built(
        block_with("[[region]]\nname = \"tumour\"\nlow = [0.009, 0.009, 0.009]\n"
                   "high = [0.011, 0.011, 0.011]\n" +
                   stiff));
  });
  EXPECT_TRUE(contains(text,
                       "tissue.region_material[0].region: region \"tumour\" holds the middle "
                       "of no element"))
      << text;
}

}  // namespace
}  // namespace trocar
