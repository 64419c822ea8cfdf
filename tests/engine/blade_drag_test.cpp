// How tissue holds back a blade, and that it is not thrown by it.
#include "engine/blade_drag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine_scene.h"
#include "engine_started.h"
#include "mesh/generate.h"
#include "scene_parts.h"
#include "solver_body.h"

namespace trocar {
namespace {

// Eight tetrahedra's worth of tissue at rest; an edge of 20 mm in two elements moves along x.
struct Edge {
  Body body =
      make_body(make_box(Vec3::Zero(), Vec3::Constant(0.01), {1, 1, 1}, BoxElements::tet4_kuhn));
  std::vector<SegmentPiece> piece = {
      {.middle = {.element = 0, .weight = {0.1, 0.2, 0.3, 0.4}}, .length = 0.005},
      {.middle = {.element = 3, .weight = {0.7, 0.1, 0.1, 0.1}}, .length = 0.015}};
  BladeDrag drag;
  std::vector<double> force = std::vector<double>(body.scratch.force.size(), 0.0);
  static constexpr double resistance = 5, length = 0.02, speed = 0.1, dt = 1e-3;

  Edge() {
    body.state.last_dt = dt;
    add_engaged_edge({.tool = 0, .piece = piece, .velocity = speed * Vec3::UnitX()}, body.mesh,
                     body.part, resistance, drag);
  }
  void step() { add_drag(body.model, body.state, dt, drag, force); }
  double sum(int axis) const {
    double total = 0;
    for (std::size_t k = static_cast<std::size_t>(axis); k < force.size(); k += 3)
      total += force[k];
    return total;
  }
};

TEST(BladeDrag, is_the_resistance_times_the_length_inside_where_tissue_is_far_slower) {
  Edge edge;
  for (double& m : edge.body.model.mass) m = 1;  // 1 kg * 0.1 m/s in 1 ms would take 100 N a node
  edge.step();
  EXPECT_NEAR(edge.sum(0), Edge::resistance * Edge::length, 1e-16);
  EXPECT_EQ(edge.sum(1), 0);
  EXPECT_EQ(edge.sum(2), 0);
}

TEST(BladeDrag, takes_light_nodes_to_the_speed_of_the_blade_and_no_further) {
  Edge edge;
  edge.step();
  ASSERT_FALSE(edge.drag.node.empty());
  for (const BladeDrag::Node& node : edge.drag.node) {
    const double mass = edge.body.model.mass[node.local];
    const double speed = node.force / mass * Edge::dt;  // undamped, from rest
    EXPECT_LE(speed, Edge::speed * (1 + 1e-12));
    EXPECT_NEAR(speed, std::min(Edge::speed, node.most / mass * Edge::dt), 1e-15);
  }
}

TEST(BladeDrag, does_not_pull_at_tissue_that_is_ahead_of_the_blade) {
  Edge edge;
  for (std::size_t k = 0; k < edge.body.state.v.size(); k += 3) edge.body.state.v[k] = 0.2;
  edge.step();
  EXPECT_EQ(edge.sum(0), 0);
}

// In tissue that comes towards a blade at rest it is what the blade meets in tissue at rest, and
// where both move alike it only keeps the tissue from falling behind.
TEST(BladeDrag, is_against_the_motion_of_the_tissue_along_the_blade) {
  Edge moving, resting;
  resting.drag.node.clear();
  const Vec3 tissue = -Edge::speed * Vec3::UnitX();
  add_engaged_edge({.tool = 0, .piece = resting.piece, .tissue_velocity = tissue},
                   resting.body.mesh, resting.body.part, Edge::resistance, resting.drag);
  for (std::size_t k = 0; k < resting.body.state.v.size(); k += 3)
    resting.body.state.v[k] = tissue.x();
  moving.step();
  resting.step();
  EXPECT_GT(moving.sum(0), 0);
  EXPECT_NEAR(resting.sum(0), moving.sum(0), 1e-15);
  EXPECT_EQ(resting.sum(1), 0);
  BladeDrag along;
  add_engaged_edge({.piece = moving.piece, .velocity = tissue, .tissue_velocity = tissue},
                   moving.body.mesh, moving.body.part, Edge::resistance, along);
  for (const BladeDrag::Node& node : along.node) EXPECT_EQ(node.direction, -Vec3::UnitX());
  BladeDrag none;
  add_engaged_edge({.piece = moving.piece}, moving.body.mesh, moving.body.part, Edge::resistance,
                   none);
  EXPECT_TRUE(none.node.empty());
}

TEST(BladeDrag, on_the_tool_is_what_it_is_on_the_tissue) {
  Edge edge;
  edge.step();
  edge.step();
  for (BladeDrag::Node& node : edge.drag.node) node.arm = Vec3(0, 0, 0.03);
  std::vector<ToolLoad> reaction(1);
  sum_drag_reactions(edge.drag, 2, reaction);
  EXPECT_NEAR(reaction[0].force[0].value(), -edge.sum(0) / 2, 1e-15);
  EXPECT_EQ(reaction[0].force[1].value(), 0);
  EXPECT_NEAR(reaction[0].torque[1].value(), -0.03 * edge.sum(0) / 2, 1e-15);
}

// A blade of 40 mm goes through a block of the same height, its tip at a depth that is no multiple
// of the distance of points on its edge: mean force in the middle of the stroke [N], its mean
// torque about the tip [N m] and the largest length inside [m].
struct Resisted {
  double force = 0, torque = 0, inside = 0;
};
Resisted resisted_at(double depth) {
  const std::string height = std::to_string(0.04 - depth);
  const auto started = built(
      "[time]\nduration = 0.5\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\nlow = [-0.03, -0.015, 0]\nhigh = [0.03, 0.015, 0.04]\ncells = [10, 5, 7]\n"
      "[tissue.material]\nyoung_modulus = 6000\n[solver]\nmass_damping = 25\n[contact]\n"
      "friction = 0\n[cutting]\nresistance = 20\n[[support]]\nregion = \"y-\"\n[[support]]\n"
      "region = \"y+\"\n[[support]]\nregion = \"z-\"\n"
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.04\npath = [\n"
      "{ time = 0, position = [-0.04, 0, " +
      height + "] },\n{ time = 0.5, position = [0.03, 0, " + height + "] } ]\n" + metrics_table);
  Simulation& s = *started->s;
  Resisted resisted;
  int n = 0;
  while (s.frame < 30) {
    run_frame(s, started->outputs);
    const ToolRow& blade = s.log.rows.back().tools[0];
    if (std::abs(blade.position.x()) > 0.015) continue;
    resisted.force -= blade.force.x();
    resisted.torque -= blade.torque.y();
    ++n;
  }
  resisted.force /= n;
  resisted.torque /= n;
  resisted.inside = s.cuts[0].strokes.back().deepest;
  return resisted;
}

// The free end bulges by up to 1.7 mm where the blade enters; in the middle of the stroke the top
// lies within 1 % of the depth where it was. The force's place is the middle of the length inside.
TEST(CutWithResistance, is_held_back_by_the_length_of_its_edge_inside_at_every_depth) {
  for (const double depth : {0.0170, 0.0190, 0.0205}) {
    const Resisted resisted = resisted_at(depth);
    EXPECT_NEAR(resisted.force, 20 * depth, 0.02 * 20 * depth) << depth;
    EXPECT_NEAR(resisted.torque, 20 * depth * depth / 2, 0.04 * 20 * depth * depth / 2) << depth;
    EXPECT_NEAR(resisted.inside, depth, 0.0018) << depth;
  }
}

// A blade longer than the block is high enters its free end, which its resistance bends away: what
// springs back past the edge must be cut too.
TEST(CutWithResistance, parts_a_block_whose_end_gives_way) {
  const auto started = built(
      "[time]\nduration = 2\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\nlow = [-0.04, -0.025, 0]\nhigh = [0.04, 0.025, 0.024]\ncells = [13, 8, 4]\n"
      "[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.45\ndensity = 1060\n"
      "[solver]\nmass_damping = 25\n[cutting]\nresistance = 12\n[checkpoint]\nevery = 0\n"
      "[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n"
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.04\npath = [\n"
      "{ time = 0.1, position = [-0.055, -0.012, -0.008], forward = [0.966, 0.259, 0] },\n"
      "{ time = 0.9, position = [0.06, 0.0188, -0.008], forward = [0.966, 0.259, 0] } ]\n");
  Simulation& s = *started->s;
  while (s.frame < 57) run_frame(s, started->outputs);
  EXPECT_EQ(s.n_pieces, 2);
  EXPECT_TRUE(s.log.events.size() == 1) << "no roll-backs";
}

}  // namespace
}  // namespace trocar
