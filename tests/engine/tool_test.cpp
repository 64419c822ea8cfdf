#include "engine/tool.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace trocar {
namespace {

SceneInstrument instrument_of(InstrumentKind kind) {
  return {.kind = kind, .name = "tool", .path = {{.time = 0, .position = Vec3(0.1, 0.2, 0.3)}}};
}

// The thickened piece's least coordinate along an axis.
double lowest(const ConvexPiece& piece, int axis) {
  double low = 1e300;
  for (const Vec3& point : piece.points) low = std::min(low, point[axis] - piece.radius);
  return low;
}

TEST(Tool, of_every_kind_has_a_shaft_a_working_piece_and_a_picture) {
  for (const InstrumentKind kind : {InstrumentKind::probe, InstrumentKind::grasper,
                                    InstrumentKind::scalpel, InstrumentKind::scissors}) {
    const Tool tool = make_tool(instrument_of(kind), {}, 1e-3);
    ASSERT_GT(tool.shape.pieces.size(), static_cast<std::size_t>(first_working_piece));
    EXPECT_FALSE(tool.parts.empty());
    for (const ToolPart& part : tool.parts) {
      EXPECT_FALSE(part.surface.triangle.empty());
      for (const auto& triangle : part.surface.triangle)
        for (const std::int32_t node : triangle) {
          EXPECT_GE(node, 0);
          EXPECT_LT(node, static_cast<std::int32_t>(part.surface.X.size()));
        }
    }
  }
}

// A scalpel's that ended beside its long blade would push away what the blade should cut.
TEST(Tool, the_shaft_begins_behind_blade_and_jaws_and_leads_away_from_them) {
  for (const InstrumentKind kind : {InstrumentKind::probe, InstrumentKind::grasper,
                                    InstrumentKind::scalpel, InstrumentKind::scissors}) {
    SceneInstrument instrument = instrument_of(kind);
    instrument.blade_length = 0.25;
    instrument.length = 0.01;
    const Tool tool = make_tool(instrument, {}, 1e-2);
    const std::vector<Vec3>& shaft = tool.shape.pieces[0].points;
    EXPECT_GT(shaft[1].z(), shaft[0].z());
    for (const Vec3& point : tool.edge) EXPECT_LT(point.z(), shaft[0].z());
  }
}

// What touches is in the picture, and open scissors have room between their blades.
TEST(Tool, with_a_surface_of_the_users_keeps_its_shaft) {
  for (const InstrumentKind kind : {InstrumentKind::probe, InstrumentKind::grasper,
                                    InstrumentKind::scalpel, InstrumentKind::scissors}) {
    const Tool built_in = make_tool(instrument_of(kind), {}, 1e-3);
    const TriangleMesh mesh = make_box_surface(Vec3(-2e-3, -1e-3, 0), Vec3(0, 1e-3, 1e-2));
    const Tool tool = make_tool(instrument_of(kind), mesh, 1e-3);
    const ConvexPiece& shaft = tool.shape.pieces[0];
    EXPECT_EQ(shaft.points, built_in.shape.pieces[0].points);
    ASSERT_EQ(tool.parts.size(), 2U);
    const Vec3 middle = 0.5 * (shaft.points[0] + shaft.points[1]);
    double farthest = 0;
    for (const Vec3& x : tool.parts[1].surface.X)
      farthest = std::max(farthest, (x - middle).norm());
    EXPECT_NEAR(farthest, 0.5 * (shaft.points[1] - shaft.points[0]).norm() + shaft.radius, 1e-9);
    const bool is_open_apart = kind == InstrumentKind::scissors;
    const std::size_t n_open = is_open_apart ? built_in.open_end : first_working_piece + 1;
    EXPECT_EQ(std::min(tool.open_end, tool.shape.pieces.size()), n_open);
    EXPECT_EQ(tool.shape.pieces.back().points.size(), mesh.X.size());
    EXPECT_EQ(tool.shape.pieces.back().has_edge, kind == InstrumentKind::scalpel);
  }
}

TEST(Tool, the_tip_of_a_probe_is_a_ball_that_touches_the_origin) {
  const SceneInstrument probe = instrument_of(InstrumentKind::probe);
  const Tool tool = make_tool(probe, {}, 1e-3);
  EXPECT_DOUBLE_EQ(lowest(tool.shape.pieces[1], 2), 0);
  for (const ConvexPiece& piece : tool.shape.pieces) EXPECT_GE(lowest(piece, 2), -1e-18);
}

TEST(Tool, a_scalpel_has_its_edge_on_the_z_axis_from_the_tip_to_the_blades_length) {
  SceneInstrument scalpel = instrument_of(InstrumentKind::scalpel);
  scalpel.blade_length = 0.02;
  for (const double spacing : {1e-3, 3e-3, 1.0}) {
    const Tool tool = make_tool(scalpel, {}, spacing);
    ASSERT_GE(tool.edge.size(), 3u);
    EXPECT_EQ(tool.edge.front(), Vec3::Zero());
    EXPECT_EQ(tool.edge.back(), Vec3(0, 0, 0.02));
    for (std::size_t k = 1; k < tool.edge.size(); ++k) {
      EXPECT_LE((tool.edge[k] - tool.edge[k - 1]).norm(), std::min(spacing, 0.01) + 1e-17);
      EXPECT_GT(tool.edge[k].z(), tool.edge[k - 1].z());
    }
  }
}

TEST(Tool, the_body_of_a_blade_lies_behind_its_edge) {
  const Tool tool = make_tool(instrument_of(InstrumentKind::scalpel), {}, 1e-3);
  for (const Vec3& point : tool.shape.pieces[first_working_piece].points) EXPECT_LE(point.x(), 0);
}

TEST(Tool, the_jaws_of_a_grasper_mirror_each_other) {
  const Tool tool = make_tool(instrument_of(InstrumentKind::grasper), {}, 1e-3);
  ASSERT_EQ(tool.shape.pieces.size(), 4u);
  const ConvexPiece &upper = tool.shape.pieces[1], &lower = tool.shape.pieces[2];
  for (std::size_t k = 0; k < upper.points.size(); ++k)
    EXPECT_EQ(upper.points[k],
              Vec3(-lower.points[k].x(), lower.points[k].y(), lower.points[k].z()));
  EXPECT_GT(upper.points[1].x(), 0);
}

TEST(Tool, closed_jaws_lie_between_the_open_ones) {
  for (const InstrumentKind kind : {InstrumentKind::grasper, InstrumentKind::scissors}) {
    const Tool tool = make_tool(instrument_of(kind), {}, 1e-3);
    ASSERT_EQ(tool.shape.pieces.size(), tool.closed_begin + 1);
    EXPECT_EQ(tool.open_end, tool.closed_begin);
    const ConvexPiece& closed = tool.shape.pieces.back();
    for (const Vec3& point : closed.points) {
      EXPECT_EQ(point.x(), 0);
      EXPECT_LE(point.z(), tool.hinge_height);
    }
    EXPECT_GT(lowest(closed, 0), lowest(tool.shape.pieces[2], 0));
    EXPECT_LT(tool.caught, closed.radius);
  }
}

TEST(Tool, the_box_round_a_tool_holds_its_thickened_pieces) {
  for (const InstrumentKind kind : {InstrumentKind::probe, InstrumentKind::grasper}) {
    const Tool tool = make_tool(instrument_of(kind), {}, 1e-3);
    double low = 0;
    for (const ConvexPiece& piece : tool.shape.pieces) low = std::min(low, lowest(piece, 0));
    EXPECT_EQ(tool.box.low.x(), low);
    EXPECT_GE(tool.box.high.z(), tool.shape.pieces[0].points[1].z());
  }
}

TEST(Tool, a_surface_of_the_users_own_replaces_the_working_piece_and_the_picture) {
  const TriangleMesh own = make_box_surface(Vec3(-1e-3, -1e-3, 0), Vec3(1e-3, 1e-3, 5e-3));
  const Tool tool = make_tool(instrument_of(InstrumentKind::probe), own, 1e-3);
  ASSERT_EQ(tool.shape.pieces.size(), 2u);
  EXPECT_EQ(tool.shape.pieces[first_working_piece].points, own.X);
  EXPECT_EQ(tool.shape.pieces[first_working_piece].radius, 0);
  ASSERT_EQ(tool.parts.size(), 2u);  // and the shaft
  EXPECT_EQ(tool.parts[0].surface.X, own.X);
  EXPECT_EQ(tool.own_mesh.X, own.X);
}

Tool tool_with(InstrumentKind kind, const std::vector<std::pair<double, GraspAction>>& actions) {
  SceneInstrument result = instrument_of(kind);
  result.path.clear();
  for (const auto& [time, action] : actions)
    result.path.push_back({.time = time, .action = action});
  return make_tool(result, {}, 1e-3);
}

Tool grasper_with(const std::vector<std::pair<double, GraspAction>>& actions) {
  return tool_with(InstrumentKind::grasper, actions);
}

Tool moving_scissors() {
  return tool_with(InstrumentKind::scissors,
                   {{0, GraspAction::none}, {1, GraspAction::close}, {2, GraspAction::open}});
}

// Else nothing would ever lie inside.
TEST(Tool, a_flat_surface_of_the_users_own_touches_as_a_thin_plate) {
  const TriangleMesh flat{.X = {{0, 0, 0}, {0.02, 0, 0.02}, {0.02, 0.01, 0.02}, {0, 0.01, 0}},
                          .triangle = {{0, 1, 2}, {0, 2, 3}}};
  const Tool tool = make_tool(instrument_of(InstrumentKind::probe), flat, 1e-3);
  const Vec3 normal = Vec3(-1, 0, 1).normalized();
  double low = 0, high = 0;
  for (const Vec3& point : tool.shape.pieces.back().points) {
    low = std::min(low, normal.dot(point));
    high = std::max(high, normal.dot(point));
  }
  EXPECT_NEAR(low, -0.025e-3, 1e-9);
  EXPECT_NEAR(high, 0.025e-3, 1e-9);
  EXPECT_EQ(tool.parts[0].surface.X, flat.X);
}

TEST(Scissors, cut_only_while_they_close) {
  const Tool tool = moving_scissors();
  EXPECT_FALSE(is_cutting(tool, 0.5, 0.6));
  EXPECT_TRUE(is_cutting(tool, 0.79, 0.81));
  EXPECT_TRUE(is_cutting(tool, 0.99, 1.01));
  EXPECT_FALSE(is_cutting(tool, 1.0, 1.1));
  EXPECT_FALSE(is_cutting(tool, 1.85, 1.95));
}

// The path holds the tip at the origin, z up the shaft: the pivot is 20 mm above it.
TEST(Scissors, cut_across_their_open_wedge_from_the_pivot_to_the_tips) {
  const Tool tool = moving_scissors();
  const double length = 0.02, opening = std::tan(0.3);
  double last = length;
  for (const double time : {0.8, 0.85, 0.9, 0.95, 1.0}) {
    const std::vector<Vec3> edge = cutting_edge(tool, time);
    ASSERT_EQ(edge.size(), tool.edge.size());
    const double below = length - edge[0].z();
    for (const Vec3& point : edge) {
      EXPECT_NEAR(point.z(), edge[0].z(), 1e-15);
      EXPECT_EQ(point.y(), 0);
    }
    // The tangent of 0.3 by two terms of its series, the third being 0.3^5 2 / 15.
    EXPECT_NEAR(edge.front().x(), -opening * below, 4e-4 * below);
    EXPECT_NEAR(edge.back().x(), opening * below, 4e-4 * below);
    EXPECT_LT(edge[0].z(), last);
    last = edge[0].z();
  }
  EXPECT_NEAR(last, 0, 1e-15);
}

TEST(JawOpening, is_full_until_the_jaws_start_to_close_and_none_when_they_meet_at_the_key) {
  const Tool tool =
      grasper_with({{0, GraspAction::none}, {1, GraspAction::close}, {2, GraspAction::open}});
  EXPECT_EQ(jaw_opening(tool, 0), 1);
  EXPECT_DOUBLE_EQ(jaw_opening(tool, 0.8), 1);
  EXPECT_NEAR(jaw_opening(tool, 0.9), 0.5, 1e-15);  // half of the 0.2 s
  EXPECT_NEAR(jaw_opening(tool, 1), 0, 1e-15);
  EXPECT_NEAR(jaw_opening(tool, 1.5), 0, 1e-15);
  EXPECT_NEAR(jaw_opening(tool, 1.9), 0.5, 1e-14);
  EXPECT_NEAR(jaw_opening(tool, 2), 1, 1e-15);
  EXPECT_EQ(jaw_opening(tool, 9), 1);
}

TEST(JawOpening, stays_between_open_and_closed_without_jumps) {
  const Tool tool = grasper_with(
      {{0.1, GraspAction::close}, {0.5, GraspAction::open}, {0.9, GraspAction::close}});
  double last = jaw_opening(tool, 0);
  for (double time = 0; time < 1.5; time += 1e-3) {
    const double opening = jaw_opening(tool, time);
    EXPECT_GE(opening, 0);
    EXPECT_LE(opening, 1);
    EXPECT_LE(std::abs(opening - last), 1e-3 / 0.2 + 1e-12) << time;  // 0.2 s for the whole way
    last = opening;
  }
}

TEST(PartPose, of_the_shaft_is_the_tools_and_that_of_a_jaw_keeps_the_hinge) {
  const Tool tool = grasper_with({{0, GraspAction::none}, {1, GraspAction::close}});
  const Vec3 hinge(0, 0, tool.hinge_height);
  for (const double time : {0.0, 0.9, 1.0})
    for (const ToolPart& part : tool.parts) {
      const Pose pose = part_pose(tool, part, time), whole = tool.path.at(time);
      EXPECT_LT((pose.apply(hinge) - whole.apply(hinge)).norm(), 1e-16) << time;
      if (part.jaw == 0) {
        EXPECT_EQ(pose.rotation.coeffs(), whole.rotation.coeffs());
      }
    }
}

TEST(PartPose, jaws_open_to_both_sides_and_come_together) {
  const Tool tool = grasper_with({{0, GraspAction::none}, {1, GraspAction::close}});
  std::map<int, std::vector<double>> tip_x;
  for (const ToolPart& part : tool.parts)
    for (const double time : {0.0, 0.9, 1.0})
      tip_x[part.jaw].push_back(part_pose(tool, part, time).apply(Vec3::Zero()).x());
  ASSERT_EQ(tip_x[1].size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GT(tip_x[1][k], 0);
    EXPECT_NEAR(tip_x[1][k], -tip_x[-1][k], 1e-17);
  }
  EXPECT_GT(tip_x[1][0], tip_x[1][1]);
  EXPECT_GT(tip_x[1][1], tip_x[1][2]);
}

}  // namespace
}  // namespace trocar
