// Graspers that pull harder than they grip.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "engine_split.h"
#include "engine_started.h"
#include "larger_or_nan.h"

namespace trocar {
namespace {

// A bar of 60 x 12 x 12 mm, held at one end; a grasper takes the other end and pulls it out by
// 30 mm in half a second.
std::unique_ptr<Started> pulled_bar(const std::string& grip) {
  return built(
      "[time]\nduration = 10\n[tissue.shape]\nkind = \"box\"\nlow = [0, 0, 0]\n"
      "high = [0.06, 0.012, 0.012]\ncells = [15, 3, 3]\n[tissue.material]\nyoung_modulus = 10000\n"
      "[solver]\nmass_damping = 20\n[[support]]\nregion = \"x-\"\n[[instrument]]\n"
      "kind = \"grasper\"\n" +
      grip +
      "path = [{ time = 0, position = [0.058, 0.006, 0.0135] }, { time = 0.3, position = [0.058, "
      "0.006, 0.0135], action = \"close\" }, { time = 0.8, position = [0.088, 0.006, 0.0135] }]\n");
}

TEST(GripForce, lets_tissue_slip_that_pulls_harder) {
  const auto bar = pulled_bar("grip_force = \"0.3 N\"\n");
  Simulation& s = *bar->s;
  bool was_held = false;
  double before = 0;
  for (int frame = 0; frame < 27; ++frame) {
    run_frame(s, bar->outputs);
    const FrameRow& row = s.log.rows.back();
    const double pull = row.tools[0].force.norm();
    if (pull > 0.3) {
      EXPECT_LE(before, 0.3);
      EXPECT_TRUE(s.holds.holds.empty());
      EXPECT_TRUE(s.holds.prescribed.empty());
      EXPECT_TRUE(contains(s.log.events.back(), "tissue slips out of grasper"))
          << s.log.events.back();
    }
    EXPECT_TRUE(before <= 0.3 || row.n_held == 0) << row.n_held;
    was_held = was_held || row.n_held > 3;
    before = larger_or_nan(before, pull);
  }
  EXPECT_TRUE(was_held);
  EXPECT_GT(before, 0.3);
  EXPECT_LT(before, 0.36);  // what a frame adds
  EXPECT_EQ(s.log.rows.back().tools[0].force, Vec3::Zero());
}

TEST(GripForce, is_without_bound_if_absent) {
  const auto bar = pulled_bar("");
  for (int frame = 0; frame < 27; ++frame) run_frame(*bar->s, bar->outputs);
  EXPECT_GT(bar->s->log.rows.back().tools[0].force.norm(), 0.36);
  EXPECT_GT(bar->s->log.rows.back().n_held, 3);
}

// A grasper that lies along a block holds a little of it, and leans on the rest. grip: in newton,
// 0: any. The largest force of all and the largest pull of what it holds; 0 once it has slipped.
struct LeaningGrip {
  double force = 0, pull = 0;
  std::size_t n_held = 0;
};
LeaningGrip leaning_grip(double grip) {
  const auto block = built(
      "[time]\nduration = 10\n[tissue.shape]\nkind = \"box\"\nlow = [-0.03, -0.012, 0]\n"
      "high = [0.03, 0.012, 0.02]\ncells = [15, 6, 5]\n[tissue.material]\n"
      "young_modulus = 5000\n[solver]\nmass_damping = 30\n[[support]]\nregion = \"z-\"\n"
      "[[instrument]]\nkind = \"grasper\"\ngrip_radius = 0.0055\ngrip_force = " +
      std::to_string(grip) +
      "\npath = [{ time = 0, position = [-0.028, 0, 0.0235], direction = [-1, 0, 0], forward = [0, "
      "1, 0] }, "
      "{ time = 0.3, position = [-0.028, 0, 0.0235], direction = [-1, 0, 0], forward = [0, 1, 0], "
      "action = \"close\" }, { time = 0.8, position = [-0.028, 0, 0.0205], "
      "direction = [-1, 0, 0], forward = [0, 1, 0] }]\n");
  Simulation& s = *block->s;
  LeaningGrip most;
  while (s.frame < 30) {
    run_frame(s, block->outputs);
    const ToolRow& tool = s.log.rows.back().tools[0];
    most.force = larger_or_nan(most.force, tool.force.norm());
    most.pull = larger_or_nan(most.pull, tool.pull.norm());
  }
  most.n_held = s.holds.holds.size();
  return most;
}

TEST(GripForce, is_not_that_of_what_the_grasper_leans_on) {
  const LeaningGrip any = leaning_grip(0);
  std::printf("%zu nodes pull with %.4f N, all with %.4f N\n", any.n_held, any.pull, any.force);
  ASSERT_GT(any.n_held, 0U);
  ASSERT_GT(any.force, 1.5 * any.pull);
  const double between = std::sqrt(any.force * any.pull);
  EXPECT_EQ(leaning_grip(between).n_held, any.n_held);
  EXPECT_EQ(leaning_grip(0.7 * any.pull).n_held, 0U);
}

// A block from low_x to 20 mm that a grasper at its plane x = 0 takes by the top and lifts by 4 mm.
FrameRow lifted_block(const std::string& low_x, const std::string& cells,
                      const std::string& mirror) {
  const auto block =
      built("[time]\nduration = 10\nframe_rate = 20\n[tissue.shape]\nkind = \"box\"\nlow = [" +
            low_x + ", -0.01, 0]\nhigh = [0.02, 0.01, 0.01]\ncells = [" + cells +
            ", 8, 4]\n[tissue.material]\nyoung_modulus = 3000\n[solver]\nmass_damping = 10\n"
            "[[support]]\nregion = \"z-\"\n" +
            mirror +
            "[[instrument]]\nkind = \"grasper\"\nradius = 0.001\ngrip_radius = 0.0045\n"
            "path = [{ time = 0, position = [0, 0, 0.015], forward = [0, 1, 0] }, "
            "{ time = 0.2, position = [0, 0, 0.011], forward = [0, 1, 0], action = \"close\" }, "
            "{ time = 0.5, position = [0, 0, 0.015], forward = [0, 1, 0] }]\n");
  for (int frame = 0; frame < 20; ++frame) run_frame(*block->s, block->outputs);
  return block->s->log.rows.back();
}

// While jaws left out all that a support holds in any component, the half held 4 nodes, none of the
// plane, and pulled with 0.36 of the whole.
TEST(Grip, of_a_half_at_its_mirror_plane_is_half_of_the_whole) {
  const FrameRow whole = lifted_block("-0.02", "16", ""),
                 half = lifted_block("0", "8", "[[support]]\nregion = \"x-\"\nfix = \"x\"\n");
  const double pull = whole.tools[0].force.z(), of_half = half.tools[0].force.z();
  std::printf("whole: %ld nodes, %.5f N; half: %ld nodes, %.5f N\n", whole.n_held, pull,
              half.n_held, of_half);
  ASSERT_LT(pull, -0.05);
  EXPECT_GT(2 * half.n_held, whole.n_held);  // those in the plane count in both
  EXPECT_NEAR(of_half / pull, 0.5, 2e-3);
}

// Jaws have the new nodes between two that they hold, and pull as before.
TEST(Grip, goes_on_where_a_cut_splits_what_it_holds) {
  const auto plate = built(plate_of("tet4-five") + plate_in_use);
  Simulation& s = *plate->s;
  const auto pull = [&] { return s.log.rows.back().tools[1].force; };
  while (s.frame < 15) run_frame(s, plate->outputs);
  const Vec3 before = pull();
  const std::size_t n_held = s.holds.holds.size();
  ASSERT_GT(n_held, 8U);
  ASSERT_GT(split_plate(s, false).n_inserted, 300);
  EXPECT_GT(s.holds.holds.size(), n_held);
  run_frame(s, plate->outputs);
  EXPECT_LT((pull() - before).norm(), 0.2 * before.norm());
  split_plate(s);
  while (s.frame < 40) run_frame(s, plate->outputs);
  EXPECT_EQ(s.n_pieces, 2);
  const Pose pose = s.tools[1].path.at(40. / 50);
  for (const Hold& hold : s.holds.holds) {
    const auto i = static_cast<std::size_t>(hold.node);
    const Vec3 x = s.mesh.X[i] + Vec3::Map(&gather_state(s).u[3 * i]);
    EXPECT_LT((x - pose.apply(hold.offset)).norm(), 1e-12) << hold.node;
  }
  EXPECT_EQ(s.log.n_roll_backs, 0);
}

}  // namespace
}  // namespace trocar
