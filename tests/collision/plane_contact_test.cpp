#include "collision/plane_contact.h"

#include "collision_random.h"
#include "collision_tool.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

// Inside is to the left of a -> b: below, outward is +y.
const Segment edge = {Vec3(0.01, 0, 0), Vec3(0, 0, 0)};
constexpr double edge_margin = 1e-3;

PlaneSection section_of(const ConvexPiece& piece, const Pose& pose = {}) {
  return plane_section(make_core(piece), pose);
}

TEST(BoundaryEdges, of_a_rectangle_are_its_four_sides_with_the_inside_to_their_left) {
  const Mesh mesh = make_rectangle(0.07, 0.04, 10, 8);
  const PlaneEdges edges = boundary_edges(boundary_surface(mesh));
  EXPECT_EQ(edges.node.size(), 2u * 9 + 2u * 7);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& X : mesh.X) centre += X / mesh.n_nodes();
  for (const auto& [a, b] : edges.node) {
    const Vec3 p = mesh.X[a], q = mesh.X[b];
    EXPECT_GT((q - p).cross(centre - p).z(), 0);
  }
}

TEST(BoundaryEdges, of_a_closed_surface_are_none) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {2, 2, 2}, BoxElements::hex8);
  EXPECT_TRUE(boundary_edges(boundary_surface(mesh)).node.empty());
}

TEST(PlaneSection, of_a_sphere_has_the_radius_of_its_circle) {
  const double height = 3e-3;  // 3-4-5
  const auto found =
      touch_edge(section_of({.points = {Vec3(5e-3, 4.5e-3, height)}, .radius = tool_radius}), edge,
                 edge_margin);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->gap, 0.5e-3, tool_rounding);
  EXPECT_NEAR((found->normal + Vec3::UnitY()).norm(), 0, tool_rounding);
  EXPECT_FALSE(touch_edge(section_of({.points = {Vec3(5e-3, 1e-4, 6e-3)}, .radius = tool_radius}),
                          edge, edge_margin));
}

TEST(PlaneSection, of_a_shaft_across_the_plane_is_its_circle) {
  const ConvexPiece shaft{.points = {Vec3(4e-3, 4e-3, -0.1), Vec3(4e-3, 4e-3, 0.1)},
                          .radius = tool_radius};
  const auto found = touch_edge(section_of(shaft), edge, edge_margin);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->gap, 4e-3 - tool_radius, tool_rounding);
  // Pushed through the edge it stays one: the circle's centre is 1 mm behind.
  const ConvexPiece deep{.points = {Vec3(4e-3, -1e-3, -0.1), Vec3(4e-3, -1e-3, 0.1)},
                         .radius = tool_radius};
  const auto behind = touch_edge(section_of(deep), edge, edge_margin);
  ASSERT_TRUE(behind.has_value());
  EXPECT_NEAR(behind->gap, -1e-3 - tool_radius, 1e-14);
  EXPECT_NEAR(behind->depth, 1e-3, 1e-14);
  EXPECT_NEAR((behind->normal + Vec3::UnitY()).norm(), 0, 1e-12);
}

TEST(PlaneSection, of_a_tilted_box_is_the_polygon_that_the_plane_cuts) {
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const Pose pose{.rotation = random.rotation(), .translation = random.in_box(1e-3)};
    const Vec3 half(3e-3, 4e-3, 5e-3);
    ConvexPiece box;
    for (const int i : {-1, 1})
      for (const int j : {-1, 1})
        for (const int l : {-1, 1}) box.points.push_back(half.cwiseProduct(Vec3(i, j, l)));
    const PlaneSection section = section_of(box, pose);
    ASSERT_GE(section.points.size(), 3u);
    for (int n = 0; n < 50; ++n) {
      Vec3 p = random.in_box(6e-3);
      p.z() = 0;
      bool is_left = true;
      for (std::size_t i = 0; i < section.points.size(); ++i) {
        const Vec3 a = section.points[i], b = section.points[(i + 1) % section.points.size()];
        is_left = is_left && (b - a).cross(p - a).z() >= 0;
      }
      const Vec3 local = pose.apply_inverse(p).cwiseAbs() - half;
      if (std::abs(local.maxCoeff()) < 1e-12) continue;  // on the side itself
      EXPECT_EQ(is_left, local.maxCoeff() < 0);
    }
  }
}

TEST(TouchEdge, of_a_box_that_dips_below_the_edge_takes_its_lowest_corner) {
  ConvexPiece box;
  for (const double x : {4e-3, 6e-3})
    for (const double y : {-0.5e-3, 3e-3})
      for (const double z : {-1e-3, 1e-3}) box.points.emplace_back(x, y, z);
  const auto found = touch_edge(section_of(box), edge, edge_margin);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->gap, -0.5e-3, tool_rounding);
  EXPECT_NEAR((found->normal + Vec3::UnitY()).norm(), 0, tool_rounding);
  EXPECT_EQ(found->tissue.weight[2], 0);
}

// The box's lower side is y = 0, and the tissue's side, about +x, ends `depth` above it.
TEST(TouchEdge, of_a_box_does_not_push_tissue_aside_that_ends_at_it) {
  ConvexPiece box;
  for (const double x : {-0.08, 0.08})
    for (const double y : {0.0, 0.01})
      for (const double z : {-0.08, 0.08}) box.points.emplace_back(x, y, z);
  Random random(1);
  for (const double depth : {1e-4, 1e-6, 1e-9, 1e-12, 0.0, -1e-9}) {
    for (int k = 0; k < 200; ++k) {
      const Vec3 top(random.between(-0.03, 0.03), depth, 0);
      const Vec3 low = top + Vec3(random.between(-5e-4, 5e-4), -0.01, 0);
      const auto found = touch_edge(section_of(box), {low, top}, 4e-3);
      EXPECT_TRUE(!found || found->normal.y() < -0.5) << depth;
    }
    const auto above =
        touch_edge(section_of(box), {Vec3(0.01, depth, 0), Vec3(-0.01, depth, 0)}, 4e-3);
    ASSERT_TRUE(above) << depth;
    EXPECT_LT(above->normal.y(), -0.5) << depth;
  }
}

TEST(SignedDistance, in_the_plane_is_that_of_the_circle_or_the_polygon) {
  const PlaneSection circle =
      section_of({.points = {Vec3(1e-3, 2e-3, 3e-3)}, .radius = tool_radius});
  const SignedDistance beside = signed_distance(circle, Vec3(1e-3, -1e-3, 0));
  EXPECT_NEAR(beside.gap, 3e-3 - 4e-3, tool_rounding);  // 3-4-5
  EXPECT_NEAR((beside.normal + Vec3::UnitY()).norm(), 0, tool_rounding);
  ConvexPiece box;
  for (const double x : {-4e-3, 4e-3})
    for (const double y : {-3e-3, 3e-3})
      for (const double z : {-1e-3, 1e-3}) box.points.emplace_back(x, y, z);
  const SignedDistance inside = signed_distance(section_of(box), Vec3(3.5e-3, 1e-3, 0));
  EXPECT_NEAR(inside.gap, -0.5e-3, tool_rounding);
  EXPECT_NEAR((inside.normal - Vec3::UnitX()).norm(), 0, tool_rounding);
  EXPECT_GT(signed_distance(section_of({.points = {Vec3(0, 0, 6e-3)}, .radius = tool_radius}),
                            Vec3::Zero())
                .gap,
            0);
}

TEST(PlaneWayOut, is_the_normal_of_the_nearest_edge_for_points_inside_only) {
  const Mesh mesh = make_rectangle(0.07, 0.04, 10, 8);
  const PlaneEdges edges = boundary_edges(boundary_surface(mesh));
  EXPECT_EQ(plane_way_out(edges, mesh.X, Vec3(0.03, 0.039, 0)), Vec3(Vec3::UnitY()));
  EXPECT_EQ(plane_way_out(edges, mesh.X, Vec3(0.001, 0.02, 0)), Vec3(-Vec3::UnitX()));
  EXPECT_EQ(plane_way_out(edges, mesh.X, Vec3(0.03, 0.041, 0)), Vec3(Vec3::Zero()));
  EXPECT_EQ(plane_way_out(edges, mesh.X, Vec3(-0.01, 0.02, 0)), Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace trocar
