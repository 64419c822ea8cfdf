#include "engine/holds.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cutting/cut_constraints.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

constexpr double grip = 0.015;

// A grasper that closes at 1 s and opens at 2 s while it moves, and a probe beside it.
std::vector<Tool> moving_tools() {
  const SceneInstrument probe{
      .kind = InstrumentKind::probe, .name = "probe", .path = {{.time = 0}}};
  SceneInstrument grasper{.kind = InstrumentKind::grasper, .name = "grasper", .grip_radius = grip};
  grasper.path = {{.time = 0, .position = Vec3(0.02, 0.02, 0)},
                  {.time = 1, .position = Vec3(0.03, 0.02, 0), .action = GraspAction::close},
                  {.time = 2,
                   .position = Vec3(0.05, 0.06, 0.02),
                   .direction = Vec3(0.5, 0.2, -1),
                   .action = GraspAction::open}};
  return {make_tool(probe, {}, 1e-3), make_tool(grasper, {}, 1e-3)};
}

struct GraspedPlate {
  std::vector<Tool> tools = moving_tools();
  Mesh mesh = make_rectangle(0.07, 0.04, 15, 9);
  std::vector<std::uint8_t> fixed = std::vector<std::uint8_t>(mesh.X.size(), 0);
  Holds holds;
  GraspedPlate() {
    holds.poses.resize(2);
    holds.is_open.assign(2, 1);
  }
  int act(double t0, double t1) {  // nodes taken, -1: no grasper acted
    int n_taken = -1;
    for (const GraspAct& act :
         act_graspers(holds, tools, due_acts(tools, t0, t1), {t1, mesh.X, fixed}))
      n_taken = std::max(n_taken, 0) + act.n_taken;
    return n_taken;
  }
  std::vector<std::int32_t> nodes() const {
    std::vector<std::int32_t> list;
    for (const Hold& hold : holds.holds) list.push_back(hold.node);
    return list;
  }
};

std::vector<std::int32_t> nodes_near(const Mesh& mesh, const Vec3& centre, double radius) {
  std::vector<std::int32_t> list;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if ((mesh.X[i] - centre).norm() <= radius) list.push_back(i);
  return list;
}

TEST(Grasp, takes_exactly_the_nodes_within_the_grip_radius_of_the_tip) {
  GraspedPlate c;
  const Vec3 tip = c.tools[1].path.at(1.02).translation;
  const std::vector<std::int32_t> expected = nodes_near(c.mesh, tip, grip);
  ASSERT_GT(expected.size(), 10u);
  ASSERT_LT(expected.size(), c.mesh.X.size());
  EXPECT_EQ(c.act(0.99, 1.02), static_cast<int>(expected.size()));
  EXPECT_EQ(c.nodes(), expected);
  EXPECT_FALSE(c.holds.is_open[1]);
  EXPECT_TRUE(c.holds.is_open[0]);
}

TEST(Grasp, happens_in_the_frame_whose_half_open_span_holds_the_key) {
  GraspedPlate c;
  const auto n_due = [&](double t0, double t1) { return due_acts(c.tools, t0, t1).size(); };
  EXPECT_EQ(n_due(0.5, 0.99), 0U);
  EXPECT_EQ(n_due(1.0, 1.03), 0U);  // a key at the beginning belongs to the frame before
  EXPECT_EQ(n_due(0.97, 1.0), 1U);
  EXPECT_EQ(c.act(0.5, 0.99), -1);
  EXPECT_EQ(c.act(1.0, 1.03), -1);
  EXPECT_GT(c.act(0.97, 1.0), 0);
  EXPECT_EQ(c.act(1.0, 1.03), -1);
  EXPECT_FALSE(c.holds.holds.empty());
}

TEST(Grasp, leaves_supported_nodes_and_those_of_another_holder_alone) {
  GraspedPlate c;
  const std::vector<std::int32_t> all = nodes_near(c.mesh, c.tools[1].path.at(1).translation, grip);
  c.fixed[all[0]] = 7;
  c.holds.holds = {{.node = all[3], .support = 0}};
  EXPECT_EQ(c.act(0.9, 1), static_cast<int>(all.size()) - 2);
  const std::vector<std::int32_t> taken = c.nodes();
  EXPECT_EQ(std::count(taken.begin(), taken.end(), all[0]), 0);
  EXPECT_TRUE(std::adjacent_find(taken.begin(), taken.end(), std::greater_equal<>()) ==
              taken.end());
  const auto other = std::find_if(c.holds.holds.begin(), c.holds.holds.end(),
                                  [&](const Hold& h) { return h.node == all[3]; });
  EXPECT_EQ(other->support, 0);
  EXPECT_EQ(other->tool, -1);
}

TEST(Grasp, opening_releases_what_this_tool_holds_and_nothing_else) {
  GraspedPlate c;
  c.act(0.9, 1);
  c.holds.holds.insert(c.holds.holds.begin(), Hold{.node = 0, .support = 0});
  EXPECT_EQ(c.act(1.99, 2.01), 0);
  EXPECT_EQ(c.nodes(), std::vector<std::int32_t>{0});
  EXPECT_TRUE(c.holds.is_open[1]);
}

TEST(Grasp, closing_and_opening_within_one_frame_holds_nothing) {
  GraspedPlate c;
  EXPECT_GE(c.act(0.97, 2.0), 0);
  EXPECT_TRUE(c.holds.holds.empty());
  EXPECT_TRUE(c.holds.is_open[1]);
}

// Whoever stands first in the scene.
TEST(Grasp, hands_tissue_over_within_one_frame) {
  for (const double closes_at : {1.29, 1.275})  // later, and at the same time
    for (const std::size_t giver : {0U, 1U}) {
      GraspedPlate c;
      const SceneInstrument grasper{
          .kind = InstrumentKind::grasper, .grip_radius = grip, .path = {{}}};
      const Vec3 tip(0.03, 0.02, 0);
      for (std::size_t k = 0; k < 2; ++k) {
        SceneInstrument one = grasper;
        if (k == giver)
          one.path = {{.time = 0.5, .position = tip, .action = GraspAction::close},
                      {.time = 1.275, .position = tip, .action = GraspAction::open}};
        else
          one.path = {{.time = closes_at, .position = tip, .action = GraspAction::close}};
        c.tools[k] = make_tool(one, {}, 1e-3);
      }
      const int n = c.act(0.4, 0.5);
      EXPECT_GT(n, 10);
      EXPECT_EQ(c.act(1.26, 1.3), n) << giver;
      ASSERT_EQ(c.holds.holds.size(), static_cast<std::size_t>(n));
      EXPECT_EQ(c.holds.holds[0].tool, 1 - static_cast<int>(giver));
    }
}

TEST(Grasp, of_nothing_is_reported_as_none_taken) {
  GraspedPlate c;
  for (Vec3& X : c.mesh.X) X += Vec3(1, 0, 0);
  EXPECT_EQ(c.act(0.9, 1), 0);
  EXPECT_FALSE(c.holds.is_open[1]);
}

TEST(Grasp, tells_how_far_the_nearest_free_node_is) {
  GraspedPlate c;
  for (Vec3& X : c.mesh.X) X += Vec3(1, 0, 0);
  const Vec3 tip = c.tools[1].path.at(1).translation;
  double nearest = 1;
  for (std::size_t i = 1; i < c.mesh.X.size(); ++i)
    nearest = std::min(nearest, (c.mesh.X[i] - tip).norm());
  c.mesh.X[0] = tip;
  c.fixed[0] = all_components;  // held: not taken, nor the nearest
  const auto acts = [&] {
    return act_graspers(c.holds, c.tools, due_acts(c.tools, 0.9, 1), {1, c.mesh.X, c.fixed});
  };
  ASSERT_EQ(acts().size(), 1U);
  EXPECT_EQ(acts()[0].n_taken, 0);
  EXPECT_NEAR(acts()[0].nearest, nearest, 1e-12);
  std::fill(c.fixed.begin(), c.fixed.end(), all_components);
  EXPECT_TRUE(std::isinf(acts()[0].nearest));
}

void expect_held(const GraspedPlate& c, const std::vector<std::size_t>& expected) {
  const std::vector<std::uint8_t> is_held = held_nodes(c.holds, c.fixed);
  for (std::size_t i = 0; i < is_held.size(); ++i)
    EXPECT_EQ(is_held[i] != 0, std::count(expected.begin(), expected.end(), i) > 0) << i;
}

TEST(HeldNodes, are_those_supported_in_any_component_and_the_held) {
  GraspedPlate c;
  c.fixed[1] = 1;
  c.fixed[2] = 2;
  c.fixed[3] = 4;
  c.fixed[4] = 7;
  c.fixed[6] = 4;
  c.holds.holds = {{.node = 5, .tool = 1}, {.node = 6, .tool = 1}};
  expect_held(c, {1, 2, 3, 4, 5, 6});
  const std::vector<std::uint8_t> is_held = held_nodes(c.holds, c.fixed);
  EXPECT_EQ(std::vector(is_held.begin(), is_held.begin() + 7),
            (std::vector<std::uint8_t>{0, may_slide, may_slide, may_slide, 1, 1, 1}));
}

TEST(HeldNodes, of_a_plane_body_are_not_those_that_only_its_plane_holds) {
  GraspedPlate c;
  std::fill(c.fixed.begin(), c.fixed.end(), FixedMask{4});
  c.fixed[1] = 5;
  c.fixed[2] = 6;
  c.fixed[4] = 7;
  expect_held(c, {1, 2, 4});
}

TEST(LargestTravel, is_of_supports_and_of_graspers_that_hold) {
  GraspedPlate c;
  EXPECT_EQ(largest_travel(c.holds, c.tools, 0, 1), 0);
  c.act(0.9, 1);
  const ToolPath bent = c.tools[1].path;
  c.tools[1].path = ToolPath({c.tools[1].keys.begin(), c.tools[1].keys.begin() + 2});
  // From 20 mm to 30 mm without a turn.
  EXPECT_NEAR(largest_travel(c.holds, c.tools, 0, 1), 0.01, 1e-16);
  c.tools[1].path = bent;
  EXPECT_GT(largest_travel(c.holds, c.tools, 1, 2),
            (Vec3(0.05, 0.06, 0.02) - Vec3(0.03, 0.02, 0)).norm());
  const std::vector<SupportKey> keys = {{.time = 0}, {.time = 1, .displacement = Vec3(0, 0.05, 0)}};
  c.holds.paths = {DisplacementPath({}), DisplacementPath(keys)};
  EXPECT_NEAR(largest_travel(c.holds, c.tools, 0, 1), 0.05, 1e-16);
}

TEST(HeldNodes, do_not_move_at_the_moment_of_the_grasp_and_then_move_with_the_tool) {
  GraspedPlate c;
  c.act(0.9, 1);
  localise_holds(c.holds, whole_part(c.mesh));
  ASSERT_EQ(c.holds.prescribed.size(), c.holds.holds.size());
  aim_holds(c.holds, c.tools, c.mesh.X, 1);
  // pose.apply(pose.apply_inverse(x)) = x up to a few roundings of 0.1 m.
  for (const PrescribedNode& node : c.holds.prescribed) EXPECT_LT(node.u_next.norm(), 1e-16);
  aim_holds(c.holds, c.tools, c.mesh.X, 1.6);
  const Pose then = c.tools[1].path.at(1), now = c.tools[1].path.at(1.6);
  for (std::size_t k = 0; k < c.holds.prescribed.size(); ++k) {
    const Vec3 X = c.mesh.X[c.holds.holds[k].node];
    const Vec3 expected = now.apply(then.apply_inverse(X)) - X;
    EXPECT_EQ(c.holds.prescribed[k].u_next, expected);
  }
}

TEST(HeldNodes, of_a_moving_support_have_the_displacement_of_its_path) {
  GraspedPlate c;
  const std::vector<SupportKey> keys = {{.time = 0},
                                        {.time = 2, .displacement = Vec3(0.01, 0.02, 0)}};
  c.holds.paths.emplace_back(keys);
  c.holds.holds = {{.node = 3, .support = 0}, {.node = 8, .support = 0}};
  localise_holds(c.holds, whole_part(c.mesh));
  for (const double time : {0.0, 0.7, 2.0, 3.0}) {
    aim_holds(c.holds, c.tools, c.mesh.X, time);
    for (const PrescribedNode& node : c.holds.prescribed)
      EXPECT_EQ(node.u_next, c.holds.paths[0].at(time));
  }
  EXPECT_EQ(c.holds.prescribed[0].u_next, Vec3(0.01, 0.02, 0));
}

TEST(HeldNodes, are_prescribed_by_their_owner_alone) {
  GraspedPlate c;
  c.act(0.9, 1);
  const std::vector<std::int32_t> owner = partition_nodes(c.mesh, 3);
  std::vector<std::int32_t> seen;
  for (int rank = 0; rank < 3; ++rank) {
    const Part part = make_part(c.mesh, owner, rank);
    localise_holds(c.holds, part);
    ASSERT_EQ(c.holds.prescribed.size(), c.holds.owned.size());
    for (std::size_t k = 0; k < c.holds.owned.size(); ++k) {
      const std::int32_t node = c.holds.holds[c.holds.owned[k]].node;
      EXPECT_EQ(part.node_global[c.holds.prescribed[k].node], node);
      EXPECT_EQ(owner[node], rank);
      seen.push_back(node);
    }
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, c.nodes());
}

TEST(EditOfHolds, partners_of_held_nodes_are_held_at_the_same_offset_in_ascending_order) {
  GraspedPlate c;
  c.act(0.9, 1);
  const std::vector<Hold> before = c.holds.holds;
  const std::int32_t n_nodes = c.mesh.n_nodes();
  // The later held node is duplicated first, then a free one, the earlier held one, and a
  // duplicate.
  MeshEdit edit;
  edit.duplicate_parent = {before[7].node, n_nodes - 1, before[2].node, n_nodes};
  apply_edit_to_holds(edit, n_nodes, c.holds);
  ASSERT_EQ(c.holds.holds.size(), before.size() + 3);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(c.holds.holds[k].node, before[k].node);
  const std::vector<std::pair<std::int32_t, std::size_t>> partners = {
      {n_nodes, 7}, {n_nodes + 2, 2}, {n_nodes + 3, 7}};
  for (std::size_t p = 0; p < partners.size(); ++p) {
    const Hold& partner = c.holds.holds[before.size() + p];
    EXPECT_EQ(partner.node, partners[p].first);
    EXPECT_EQ(partner.offset, before[partners[p].second].offset);
    EXPECT_EQ(partner.tool, 1);
  }
}

TEST(EditOfHolds, nodes_on_edges_are_held_between_two_ends_that_one_holder_has) {
  GraspedPlate c;
  c.act(0.9, 1);
  std::vector<Hold>& holds = c.holds.holds;
  holds[4].tool = 0;
  holds[5] = {.node = holds[5].node, .support = 0};
  holds[6] = {.node = holds[6].node, .support = 0};
  const std::vector<Hold> before = holds;
  const std::int32_t n_nodes = c.mesh.n_nodes();
  const auto on_edge = [&](std::size_t a, std::size_t b) {
    return EdgeNode{.end = {before[a].node, before[b].node}, .s = 0.3};
  };
  MeshEdit edit;
  edit.inserted = {on_edge(0, 1),
                   on_edge(1, 4),
                   on_edge(1, 5),
                   on_edge(5, 6),
                   {.end = {0, before[1].node}, .s = 0.5}};
  edit.duplicate_parent = {n_nodes + 3, n_nodes + 1, n_nodes};  // of nodes on edges
  apply_edit_to_holds(edit, n_nodes, c.holds);
  ASSERT_EQ(holds.size(), before.size() + 4);
  const Vec3 between = before[0].offset + 0.3 * (before[1].offset - before[0].offset);
  struct Held {
    std::int32_t node = 0, tool = -1, support = -1;
    Vec3 offset = Vec3::Zero();
  };
  const std::int32_t n_before_copies = n_nodes + 5;
  const std::array<Held, 4> expected = {{{n_nodes, 1, -1, between},
                                         {n_nodes + 3, -1, 0},
                                         {n_before_copies, -1, 0},
                                         {n_before_copies + 2, 1, -1, between}}};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Hold& hold = holds[before.size() + k];
    EXPECT_EQ(hold.node, expected[k].node) << k;
    EXPECT_EQ(hold.tool, expected[k].tool) << k;
    EXPECT_EQ(hold.support, expected[k].support) << k;
    EXPECT_EQ(hold.offset, expected[k].offset) << k;
  }
}

// Before and behind an edit: what is supported or held otherwise at its two ends is free between.
TEST(EditOfHolds, nodes_that_will_be_immovable_are_so_behind_it) {
  GraspedPlate c;
  c.act(0.9, 1);
  std::vector<Hold>& holds = c.holds.holds;
  holds[4].tool = 0;
  const std::int32_t held = holds[0].node, too = holds[1].node, by_other = holds[4].node;
  c.fixed[0] = c.fixed[1] = all_components;
  c.fixed[2] = all_components - 1;
  MeshEdit edit;
  const std::vector<std::array<std::int32_t, 2>> ends = {
      {0, 1}, {0, 2}, {0, held}, {held, too}, {too, by_other}};
  for (const auto& end : ends) edit.inserted.push_back({.end = end, .s = 0.5});
  const std::int32_t n = c.mesh.n_nodes();
  edit.duplicate_parent = {held, 5, 0, n, n + 2, n + 3, n + 5};
  std::vector<std::uint8_t> will_be;
  for (std::int32_t i = 0; i < n + static_cast<std::int32_t>(edit.n_new_nodes()); ++i)
    will_be.push_back(is_immovable(c.holds, c.fixed, i, edit) ? 1 : 0);
  // As inherit_by_new_nodes (apply_cut.cpp) has it.
  for (const EdgeNode& node : edit.inserted)
    c.fixed.push_back(static_cast<FixedMask>(c.fixed[node.end[0]] & c.fixed[node.end[1]]));
  for (const std::int32_t parent : edit.duplicate_parent) c.fixed.push_back(c.fixed[parent]);
  apply_edit_to_holds(edit, n, c.holds);
  EXPECT_EQ(will_be, immovable_nodes(c.holds, c.fixed));
  EXPECT_EQ(std::vector(will_be.begin() + n, will_be.end()),
            (std::vector<std::uint8_t>{1, 0, 0, 1, 0, 1, 0, 1, 1, 0, 1, 1}));
}

double sum_of(const ExactSum& sum) {
  return sum.value();
}

TEST(HoldReactions, are_the_mean_over_the_substeps_with_the_sign_of_the_tissue_on_the_tool) {
  GraspedPlate c;
  c.holds.paths.emplace_back(std::vector<SupportKey>{{.time = 0}});
  c.holds.holds = {{.node = 1, .tool = 1}, {.node = 4, .tool = 1}, {.node = 9, .support = 0}};
  localise_holds(c.holds, whole_part(c.mesh));
  for (int step = 1; step <= 4; ++step) {
    for (std::size_t k = 0; k < 3; ++k)
      c.holds.prescribed[k].reaction = Vec3(step, 10.0 * static_cast<double>(k), 0.5);
    add_hold_reactions(c.holds);
  }
  c.holds.poses.resize(2);
  c.holds.poses[1].rotation = Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));  // x to y
  c.holds.holds[0].offset = Vec3(0.02, 0, 0);
  std::vector<ToolLoad> loads(2);
  std::vector<ExactSum3> on_support(1);
  sum_hold_reactions(c.holds, 4, loads, on_support);
  const ExactSum3 &force = loads[1].force, &torque = loads[1].torque;
  EXPECT_EQ(sum_of(force[0]), -2 * (1 + 2 + 3 + 4) / 4.0);  // two nodes
  EXPECT_EQ(sum_of(on_support[0][0]), -(1 + 2 + 3 + 4) / 4.0);
  EXPECT_EQ(sum_of(on_support[0][1]), -20);
  EXPECT_EQ(sum_of(force[1]), -10);
  EXPECT_EQ(sum_of(force[2]), -1);
  EXPECT_EQ(sum_of(loads[0].force[0]), 0);
  // Of the first node alone: (0, 0.02, 0) x (-2.5, 0, -0.5) = (-0.01, 0, 0.05).
  EXPECT_NEAR(sum_of(torque[0]), -0.01, 1e-15);
  EXPECT_NEAR(sum_of(torque[1]), 0, 1e-15);
  EXPECT_NEAR(sum_of(torque[2]), 0.05, 1e-15);
  std::vector<ToolLoad> again(2);
  sum_hold_reactions(c.holds, 4, again, on_support);
  EXPECT_EQ(sum_of(again[1].force[0]), 0);
}

}  // namespace
}  // namespace trocar
