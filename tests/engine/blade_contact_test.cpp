// A blade thicker than the wound that it makes: its flanks between the lips.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "box_file.h"
#include "engine/equilibrium.h"
#include "engine_started.h"
#include "mesh/connected_nodes.h"
#include "scene_plate.h"

namespace trocar {
namespace {

struct OnBlade {
  double along = 0;                  // mean force against the blade's way [N]
  double aside = 0, most_aside = 0;  // mean and largest across it [N]
};

// A stiff block is parted 20 mm deep in its plane of symmetry, without resistance against the edge.
OnBlade cut_in_the_middle(double friction, const std::string& of_blade = "") {
  const auto block = built(
      "[time]\nduration = 10\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"hex8\"\n"
      "low = [-0.04, -0.015, 0]\nhigh = [0.04, 0.015, 0.04]\ncells = [16, 6, 8]\n"
      "[tissue.material]\nyoung_modulus = 60000\n[solver]\nmass_damping = 30\n[contact]\n"
      "friction = " +
      std::to_string(friction) +
      "\n[[support]]\nregion = \"z-\"\n[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n"
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.04\n" +
      of_blade +
      "path = [{ time = 0.1, position = [-0.06, 0, 0.02] }, { time = 1.1, position = "
      "[0.06, 0, 0.02] }]\n");
  constexpr int n_frames = 68;
  OnBlade force;
  for (int frame = 0; frame < n_frames; ++frame) {
    run_frame(*block->s, block->outputs);
    const Vec3& f = block->s->log.rows.back().tools[0].force;
    force.along -= f.x() / n_frames;
    force.aside += f.y() / n_frames;
    force.most_aside = std::max(force.most_aside, std::abs(f.y()));
  }
  EXPECT_GT(block->s->mesh.n_nodes(), 17 * 7 * 9 + 10);  // it was cut
  return force;
}

// Nodes at the front of the wound were pushed to one flank or the other: by 0.1 N.
TEST(ContactOfABlade, does_not_push_the_front_of_its_wound_aside) {
  const OnBlade smooth = cut_in_the_middle(0);
  std::printf("aside %.2g N in the mean, %.2g N at most, along %.2g N\n", smooth.aside,
              smooth.most_aside, smooth.along);
  EXPECT_LT(std::abs(smooth.aside), 1e-3);
  EXPECT_LT(smooth.most_aside, 0.02);
  EXPECT_LT(std::abs(smooth.along), 1e-3);
  const OnBlade rough = cut_in_the_middle(0.2);
  std::printf("with friction: aside %.2g N in the mean, along %.2g N\n", rough.aside, rough.along);
  EXPECT_LT(std::abs(rough.aside), 1e-3);
  EXPECT_GE(rough.along, 0);
}

// As a hull that touches with its edge, too, it would plough through the block.
TEST(ContactOfABlade, of_a_surface_of_the_users_cuts_as_the_built_in_one_does) {
  const TestFolder folder;
  write_box(folder.file("blade.obj"), Vec3(-0.011, -0.00005, 0), Vec3(0, 0.00005, 0.04));
  const OnBlade force = cut_in_the_middle(0, "mesh = \"" + folder.file("blade.obj") + "\"\n");
  EXPECT_LT(std::abs(force.aside), 1e-3);
  EXPECT_LT(force.most_aside, 0.02);
  EXPECT_LT(std::abs(force.along), 1e-3);
}

// Its faces lie within 26 degrees of the flanks: these pressed on what the blade was about to cut,
// with 1.5 N, and the pieces had 70 and 30 % of the plate.
TEST(ContactOfABlade, does_not_push_a_plate_aside_that_it_cuts_at_a_flat_angle) {
  const auto plate = built(
      "[time]\nduration = 10\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\ncells = [12, 12, 3]\nhigh = [0.06, 0.06, 0.009]\n[tissue.material]\n"
      "young_modulus = 50000\n[solver]\nmass_damping = 50\n[contact]\nfriction = 0\n"
      "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n[[instrument]]\n"
      "kind = \"scalpel\"\nblade_length = 0.072\nlength = 0.16\npath = [{ time = 0, position = "
      "[-0.0033, 0.066, 0.01752], direction = [0, 1, 0], forward = [0.93969, 0, -0.34202] }, "
      "{ time = 0.536, position = [0.06385, 0.066, -0.00692], direction = [0, 1, 0], forward = "
      "[0.93969, 0, -0.34202] }]\n");
  Simulation& s = *plate->s;
  double most = 0;
  while (s.frame < 56) {
    run_frame(s, plate->outputs);
    most = std::max(most, s.log.rows.back().tools[0].force.norm());
  }
  EXPECT_LT(most, 0.1);
  ASSERT_EQ(s.n_pieces, 2);
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  double all = 0, first = 0;
  for (std::int32_t e = 0; e < s.mesh.n_elements(); ++e) {
    const double volume = element_volume(s.mesh, e, s.mesh.X);
    all += volume;
    if (piece[s.mesh.corners(e)[0]] == piece[0]) first += volume;
  }
  // The plane at -20 degrees goes through (-3.3, 17.52) mm; x = 0 is at 16.3 mm and meets the lower
  // face at 44.8 mm, the upper at 20.1 mm.
  std::printf("at most %.3f N, %.4f of the plate at x-\n", most, first / all);
  EXPECT_NEAR(first / all, 0.5 * (44.84 + 20.11) / 60, 0.015);
}

// They cut as they close. Large faces cross the plane of their blades beyond the tip: taken for
// faces that are being cut, these left 1.8 N.
TEST(ContactOfABlade, of_open_scissors_presses_the_faces_that_it_lies_on) {
  const std::string pose = "], direction = [0, 0.98481, -0.17365], forward = [1, 0, 0] }";
  const auto block = built(
      "[time]\nduration = 10\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\nlow = [-0.04, -0.04, 0]\nhigh = [0.04, 0.04, 0.04]\ncells = [6, 6, 3]\n"
      "[tissue.material]\nyoung_modulus = 8000\n[solver]\nmass_damping = 30\n[[support]]\nregion "
      "= \"z-\"\n[[instrument]]\nkind = \"scissors\"\nblade_length = 0.02\nlength = 0.15\n"
      "path = [{ time = 0, position = [0, 0.003, 0.044" +
      pose + ", { time = 0.5, position = [0, 0.003, 0.036" + pose + "]\n");
  while (block->s->frame < 36) run_frame(*block->s, block->outputs);
  EXPECT_GT(block->s->log.rows.back().tools[0].force.z(), 2.3);
}

// The back of the blade rests in the slit of a plate in pieces, where its lips are held: they lie
// in the blade for good. It threw them out again and again: 8e-5 to 2e-4 W, more at smaller steps.
TEST(ContactOfABlade, at_rest_between_held_lips_does_no_work) {
  const std::string text = plate_of("tet4-five") +
                           "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n" +
                           plate_blade + "[start]\nstate = \"equilibrium\"\n" +
                           "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n";
  for (const std::string step : {"0.85", "0.4"})
    for (const int layers : {1, 2}) {
      const auto plate = built(text, {"solver.gravity=[0,0,-0.01]", "solver.step_factor=" + step,
                                      "tissue.shape.cells=[13,9," + std::to_string(layers) + "]"});
      Simulation& s = *plate->s;
      start_in_equilibrium(plate->loaded, s);
      while (s.frame < 40) run_frame(s, plate->outputs);
      EXPECT_GT(s.n_pieces, 1);
      const double before = s.log.rows.back().works.contact;
      while (s.frame < 60) run_frame(s, plate->outputs);
      const FrameRow& row = s.log.rows.back();
      const double watts = (row.works.contact - before) / (20 * 0.02);
      std::printf("%d layers, step_factor %s: %.2g W, %.2g J of motion, %d pieces\n", layers,
                  step.c_str(), watts, row.energy.kinetic, s.n_pieces);
      EXPECT_GT(row.n_contacts, 30);
      EXPECT_LT(watts, 1e-9);
      EXPECT_LT(row.energy.kinetic, 1e-10);
    }
}

}  // namespace
}  // namespace trocar
