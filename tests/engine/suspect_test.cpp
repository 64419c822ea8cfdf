// Whom the sentence about a failed frame names.
#include "engine/suspect.h"

#include <gtest/gtest.h>

#include "engine_started.h"

namespace trocar {
namespace {

// A cube of 4 x 4 x 4 hexahedra of 25 mm with these other tables.
std::unique_ptr<Started> cube_with(const std::string& tables) {
  return built(R"([time]
duration = "1 s"
[tissue.shape]
kind = "box"
elements = "hex8"
cells = [4, 4, 4]
)" + tables);
}

// Its sides x- and y- are moved at 1 and 100 mm/s.
std::unique_ptr<Started> moved_cube() {
  return cube_with(R"([tissue.material]
model = "linear"
[[support]]
region = "x-"
path = [ { time = 0, displacement = [0, 0, 0] }, { time = "1 s", displacement = ["1 mm", 0, 0] } ]
[[support]]
region = "y-"
path = [ { time = 0, displacement = [0, 0, 0] }, { time = "1 s", displacement = [0, "100 mm", 0] } ]
)");
}

// Of the hexahedron in cell (i, j, 2).
Suspect suspect_of_cell(int i, int j) {
  const auto started = moved_cube();
  Simulation& s = *started->s;
  Watch failed{.least_J = -1};
  for (std::int32_t e = 0; e < s.mesh.n_elements(); ++e) {
    const Vec3& low = s.mesh.X[s.mesh.corners(e)[0]];
    if ((low - 0.025 * Vec3(i, j, 2)).norm() < 1e-9) failed.least_J_element = e;
  }
  EXPECT_GE(failed.least_J_element, 0);
  return find_suspect(s, failed, {.t0 = 0.5, .t1 = 0.51});
}

TEST(Suspect, is_what_moves_most_of_all_that_come_near) {
  const Suspect suspect = suspect_of_cell(0, 1);  // beside x-, a cell away from y-
  EXPECT_TRUE(contains(suspect.place, " at (0.0125, 0.0375, 0.0625) m, ")) << suspect.place;
  EXPECT_TRUE(contains(suspect.place, "m from a node held by the support of \"y-\""));
  EXPECT_TRUE(suspect.cure.starts_with("a material for large strains")) << suspect.cure;
  EXPECT_TRUE(contains(suspect.cure, "a slower or shorter path of the support of \"y-\""));
}

TEST(Suspect, is_the_near_one_where_what_moves_more_is_far) {
  const Suspect suspect = suspect_of_cell(0, 3);
  EXPECT_TRUE(contains(suspect.place, "support of \"x-\", which moves at 0.00")) << suspect.place;
  EXPECT_TRUE(contains(suspect.cure, "path of the support of \"x-\"")) << suspect.cure;
}

TEST(Suspect, is_nobody_where_none_comes_near) {
  const Suspect suspect = suspect_of_cell(3, 3);
  EXPECT_TRUE(contains(suspect.place, "support of \"")) << suspect.place;  // the nearest, anyway
  EXPECT_TRUE(contains(suspect.cure, "smaller loads")) << suspect.cure;
}

TEST(Suspect, is_the_damping_where_that_holds_the_tissue_back) {
  const auto cure_with = [](const std::string& damping) {
    const auto started = cube_with("[solver]\nmass_damping = " + damping + "\n");
    return find_suspect(*started->s, {.least_J = -1, .least_J_element = 0}, {.t0 = 0.5, .t1 = 0.51})
        .cure;
  };
  EXPECT_TRUE(cure_with("1e6").starts_with("a lower solver.mass_damping (1e+06 1/s holds"))
      << cure_with("1e6");
  EXPECT_FALSE(contains(cure_with("30"), "damping"));
}

TEST(Suspect, that_turns_moves_though_its_tip_rests) {
  const auto started = cube_with(R"([[instrument]]
kind = "grasper"
path = [
  { time = 0, position = [0.05, 0.05, 0.102] },
  { time = 0.3, position = [0.05, 0.05, 0.102], action = "close" },
  { time = 0.8, position = [0.05, 0.05, 0.102], forward = [0, 1, 0] },
]
)");
  Simulation& s = *started->s;
  while (s.frame < 33) run_frame(s, started->outputs);
  ASSERT_FALSE(s.holds.holds.empty());
  Watch failed{.least_J = -1, .least_J_element = s.mesh.n_elements() - 1};
  for (std::int32_t e = 0; e < s.mesh.n_elements(); ++e)
    if (std::ranges::count(s.mesh.corners(e), s.holds.holds[0].node) > 0)
      failed.least_J_element = e;
  const Suspect suspect = find_suspect(s, failed, {.t0 = 0.55, .t1 = 0.56});
  EXPECT_TRUE(contains(suspect.place, "held by \"grasper\", which moves at ")) << suspect.place;
  EXPECT_TRUE(contains(suspect.cure, "a slower or shorter path of \"grasper\"")) << suspect.cure;
}

// Its handle points away at the frame's beginning and sweeps over the cube, 10 mm above it.
TEST(Suspect, that_comes_by_within_the_frame_is_measured_where_it_is_nearest) {
  const auto started = cube_with(R"([[instrument]]
kind = "probe"
path = [
  { time = 0, position = [-0.01, 0.05, 0.11], direction = [0, 1, 0], forward = [0, 0, 1] },
  { time = 0.5, position = [-0.01, 0.05, 0.11], direction = [-1, -1, 0], forward = [0, 0, 1] },
]
)");
  const Watch failed{.least_J = -1, .least_J_element = started->s->mesh.n_elements() - 1};
  const Suspect suspect = find_suspect(*started->s, failed, {.t0 = 0, .t1 = 0.5});
  // 22.5 mm above the element's middle, less the shaft's radius of 1.8 mm.
  EXPECT_TRUE(contains(suspect.place, ", 0.02")) << suspect.place;
  EXPECT_TRUE(contains(suspect.place, " m from \"probe\", which moves at 0.")) << suspect.place;
  EXPECT_TRUE(contains(suspect.cure, "a slower or shorter path of \"probe\"")) << suspect.cure;
}

TEST(Suspect, that_is_a_scalpel_may_have_too_wide_a_blade) {
  const auto started = cube_with(R"([[instrument]]
kind = "scalpel"
path = [ { time = 0, position = [-0.02, 0.05, 0.11] }, { time = 1, position = [0.12, 0.05, 0.11] } ]
)");
  const Watch failed{.least_J = -1, .least_J_element = started->s->mesh.n_elements() - 1};
  const Suspect suspect = find_suspect(*started->s, failed, {.t0 = 0.8, .t1 = 0.81});
  EXPECT_TRUE(contains(suspect.cure, "path of \"scalpel\", a shorter and so narrower blade_length"))
      << suspect.cure;
}

// It said "to press less deep".
TEST(Suspect, is_the_grasper_that_has_just_let_go_of_what_it_had_stretched) {
  const auto started = cube_with(R"([[instrument]]
kind = "grasper"
path = [
  { time = 0, position = [0.05, 0.05, 0.102] },
  { time = 0.1, position = [0.05, 0.05, 0.102], action = "close" },
  { time = 0.5, position = [0.05, 0.05, 0.202], action = "open" },
]
)");
  const Watch failed{.least_J = -1, .least_J_element = 0};
  const auto cure_at = [&](double t) {
    return find_suspect(*started->s, failed, {.t0 = t, .t1 = t + 0.01}).cure;
  };
  EXPECT_TRUE(contains(cure_at(0.51), "shorter pull of \"grasper\", which has just let go"));
  EXPECT_FALSE(contains(cure_at(0.49), "let go"));
  EXPECT_FALSE(contains(cure_at(0.61), "let go"));
}

}  // namespace
}  // namespace trocar
