#include "collision/hull_manifold.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collision_tool.h"

namespace trocar {
namespace {

// A rod of 8 x 8 mm with its end at z = end, over tissue whose outward normal is +z.
PieceCore rod(double end, double radius = 0) {
  ConvexPiece piece{.radius = radius};
  for (const double x : {-4e-3, 4e-3})
    for (const double y : {-4e-3, 4e-3})
      for (const double z : {end, end + 0.02}) piece.points.emplace_back(x, y, z);
  return make_core(piece);
}

Manifold manifold_of(const PieceCore& core, const Triangle& triangle) {
  const auto nearest = touch(core, triangle, 1e-3);
  return find_manifold(core, triangle, nearest ? nearest->gap : 0, 1e-3);
}

Vec3 point_of(const Triangle& x, const ManifoldPoint& p) {
  return p.weight[0] * x[0] + p.weight[1] * x[1] + p.weight[2] * x[2];
}

// Each of these touches at one point only, as nearest points go.
TEST(HullManifold, has_all_corners_over_a_triangle) {
  const Triangle below = {Vec3(-0.03, -0.02, 0), Vec3(0.03, -0.02, 0), Vec3(0, 0.04, 0)};
  for (const double end : {-2e-4, 0.0, 5e-4}) {
    const Manifold found = manifold_of(rod(end), below);
    ASSERT_EQ(found.n_points, 4u) << end;
    for (const ManifoldPoint& p : found) {
      EXPECT_NEAR((p.normal + Vec3::UnitZ()).norm(), 0, 1e-12);
      EXPECT_NEAR(p.normal.dot(point_of(below, p) - p.point), end, tool_rounding);
      EXPECT_NEAR(p.point.cwiseAbs().x(), 4e-3, tool_rounding);
      EXPECT_NEAR(p.point.cwiseAbs().y(), 4e-3, tool_rounding);
    }
  }
}

TEST(HullManifold, has_both_ends_of_what_of_an_edge_lies_over_a_face) {
  const Triangle across = {Vec3(-0.01, 0, 0), Vec3(0.01, 1e-3, 0), Vec3(0, 0.05, 0)};
  const Manifold found = manifold_of(rod(-1e-4), across);
  std::size_t n_on_rim = 0;
  for (const ManifoldPoint& p : found) {
    EXPECT_NEAR((p.normal + Vec3::UnitZ()).norm(), 0, 1e-12);
    const Vec3 q = point_of(across, p);
    EXPECT_NEAR(p.normal.dot(q - p.point), -1e-4, tool_rounding);
    if (p.weight[2] > 0) continue;
    EXPECT_NEAR(std::abs(q.x()), 4e-3, tool_rounding);
    ++n_on_rim;
  }
  EXPECT_EQ(n_on_rim, 2u);
  EXPECT_EQ(found.n_points, 4u);  // two corners of the rod
}

TEST(HullManifold, of_a_thickened_hull_begins_at_its_radius) {
  const Triangle below = {Vec3(-0.03, -0.02, 0), Vec3(0.03, -0.02, 0), Vec3(0, 0.04, 0)};
  const Manifold found = manifold_of(rod(1.2e-3, 1e-3), below);
  ASSERT_EQ(found.n_points, 4u);
  for (const ManifoldPoint& p : found) {
    EXPECT_NEAR(p.normal.dot(point_of(below, p) - p.point), 2e-4, tool_rounding);
    EXPECT_NEAR(p.point.z(), 2e-4, tool_rounding);
  }
}

TEST(HullManifold, leaves_out_what_is_far_or_beside_or_on_the_other_side) {
  const Triangle below = {Vec3(-0.03, -0.02, 0), Vec3(0.03, -0.02, 0), Vec3(0, 0.04, 0)};
  EXPECT_EQ(manifold_of(rod(1.1e-3), below).n_points, 0u);
  // The rod's far end lies 20 mm behind it: its way out is beside.
  const Triangle wall = {Vec3(3.9e-3, 0.02, 0), Vec3(3.9e-3, -0.02, 0), Vec3(3.9e-3, 0, 0.04)};
  const Manifold at_wall = manifold_of(rod(0.005), wall);
  EXPECT_GT(at_wall.n_points, 0u);
  for (const ManifoldPoint& p : at_wall) EXPECT_NEAR((p.normal - Vec3::UnitX()).norm(), 0, 1e-12);
  const Triangle beside = {Vec3(0.01, 0, 0), Vec3(0.02, 0, 0), Vec3(0.01, 0.02, 0)};
  EXPECT_EQ(manifold_of(rod(-1e-4), beside).n_points, 0u);
}

TEST(HullManifold, of_what_is_no_solid_hull_is_empty) {
  const Triangle below = {Vec3(-0.03, -0.02, 0), Vec3(0.03, -0.02, 0), Vec3(0, 0.04, 0)};
  EXPECT_EQ(manifold_of(make_core({.points = {Vec3(0, 0, 0)}, .radius = 5e-3}), below).n_points,
            0u);
  const PieceCore flat =
      make_core({.points = {Vec3(-1e-3, -1e-3, 0), Vec3(1e-3, -1e-3, 0), Vec3(0, 1e-3, 0)}});
  EXPECT_EQ(manifold_of(flat, below).n_points, 0u);
}

}  // namespace
}  // namespace trocar
