// Graspers and scissors that are closed push tissue that they do not hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "box_file.h"
#include "engine_started.h"
#include "larger_or_nan.h"
#include "test_files.h"

namespace trocar {
namespace {

// A block of 50 x 40 x 20 mm, cells of 3.3 mm, without friction; path: of the only instrument.
std::unique_ptr<Started> block_and(const std::string& kind, const std::string& path,
                                   double step_factor = 0.85) {
  return built(
      "[time]\nduration = 10\n[tissue.shape]\nkind = \"box\"\nelements = \"tet4-kuhn\"\n"
      "low = [-0.025, -0.02, 0]\nhigh = [0.025, 0.02, 0.02]\ncells = [15, 12, 6]\n"
      "[tissue.material]\nyoung_modulus = 5000\n[solver]\nmass_damping = 20\nstep_factor = " +
      std::to_string(step_factor) +
      "\n[contact]\nfriction = 0\n[[support]]\nregion = \"z-\"\n[[instrument]]\nkind = \"" + kind +
      "\"\npath = [" + path + "]\n");
}

// Along z at the end, closed in the air and pressed `depth` mm deep.
double press_closed(const std::string& kind, double depth, double step_factor) {
  const auto block = block_and(kind,
                               "{ time = 0, position = [0.001, 0.0015, 0.05] }, { time = 0.2, "
                               "position = [0.001, 0.0015, 0.03], action = \"close\" }, { time = "
                               "0.8, position = [0.001, 0.0015, " +
                                   std::to_string(20 - depth) + "e-3] }",
                               step_factor);
  for (int frame = 0; frame < 30; ++frame) run_frame(*block->s, block->outputs);
  EXPECT_TRUE(block->s->holds.holds.empty());
  return block->s->log.rows.back().tools[0].force.z();
}

TEST(ClosedJaws, push_what_they_meet_at_the_usual_step_as_at_a_quarter_of_it) {
  for (const char* kind : {"grasper", "scissors"})
    for (const double depth : {4.0, 8.0}) {
      const double usual = press_closed(kind, depth, 0.85), fine = press_closed(kind, depth, 0.2);
      std::printf("closed %s, %.0f mm: %.4f N, %.4f N with a quarter of the step\n", kind, depth,
                  usual, fine);
      EXPECT_GT(fine, 0.1);
      EXPECT_NEAR(usual, fine, 0.02 * fine);
    }
}

// Closed in the air and pressed 4 mm deep, with a surface of the user's.
TEST(ClosedJaws, of_a_surface_of_the_users_push_with_its_hull) {
  const TestFolder folder;
  write_box(folder.file("jaws.obj"), Vec3(-0.004, -0.003, 0), Vec3(0.004, 0.003, 0.02));
  const std::string mesh = "\"\nmesh = \"" + folder.file("jaws.obj");  // behind the kind
  std::vector<double> force;
  for (const char* kind : {"grasper", "scissors"})
    force.push_back(press_closed(kind + mesh, 4, 0.85));
  EXPECT_GT(force[0], 0.1);
  EXPECT_EQ(force[1], force[0]);
}

// A grasper comes to rest on the block, waits, closes and waits.
TEST(ClosedJaws, do_not_push_what_they_took_hold_of) {
  const auto block = block_and(
      "grasper",
      "{ time = 0, position = [0, 0, 0.03] }, { time = 0.3, position = [0, 0, 0.0195] }, { time = "
      "0.8, position = [0, 0, 0.0195], action = \"close\" }, { time = 1.5, position = [0, 0, "
      "0.0195] }");
  double before = 0, most = 0, pushed = 0;
  for (int frame = 0; frame < 40; ++frame) {
    run_frame(*block->s, block->outputs);
    const FrameRow& row = block->s->log.rows.back();
    const double force = row.tools[0].force.norm();
    (row.n_held == 0 ? before : most) = std::max(row.n_held == 0 ? force : most, force);
    if (row.n_held == 0) continue;
    for (const ContactSet::Item& item : block->s->contact->set.items)
      pushed = larger_or_nan(pushed, item.reaction_sum.norm());
  }
  std::printf("before closing %.4f N, afterwards at most %.4f N\n", before, most);
  ASSERT_FALSE(block->s->holds.holds.empty());
  EXPECT_EQ(pushed, 0);
  EXPECT_LT(most, before);
}

}  // namespace
}  // namespace trocar
