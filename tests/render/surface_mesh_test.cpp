#include "render/surface_mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh/triangle_mesh.h"
#include "render_scene.h"

using namespace trocar;
using namespace trocar::testing;

namespace {

Vec3 vec(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

SurfaceMesh surface_of(const TriangleMesh& mesh) {
  return make_surface_mesh({.x = mesh.X, .X = mesh.X, .triangle = mesh.triangle});
}

// Every directed edge between positions has its opposite: the surface has no gap.
bool is_closed(const SurfaceMesh& mesh) {
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> count;
  for (std::size_t k = 0; k < mesh.index.size(); ++k) {
    const auto a = mesh.vertex[mesh.index[k]].x,
               b = mesh.vertex[mesh.index[k % 3 == 2 ? k - 2 : k + 1]].x;
    ++count[{a, b}];
    --count[{b, a}];
  }
  for (const auto& [edge, n] : count)
    if (n != 0) return false;
  return true;
}

}  // namespace

TEST(SurfaceMesh, normals_of_a_ball_point_outward) {
  const SurfaceMesh mesh = surface_of(make_sphere_surface(Vec3(1, 2, 3), 0.5, 48));
  EXPECT_GT(mesh.vertex.size(), 48U);
  for (const SurfaceVertex& v : mesh.vertex) {
    const Vec3 radial = (vec(v.x) - Vec3(1, 2, 3)).normalized();
    // Area weights err by the asymmetry of the triangles around a vertex, of the order of their
    // angle, 2 pi / 48.
    EXPECT_GT(vec(v.normal).dot(radial), std::cos(2 * 3.14159 / 48));
    EXPECT_NEAR(vec(v.normal).norm(), 1, 1e-6);
  }
}

TEST(SurfaceMesh, smooth_surface_shares_its_vertices) {
  const TriangleMesh ball = make_sphere_surface(Vec3::Zero(), 1, 24);
  EXPECT_EQ(surface_of(ball).vertex.size(), ball.X.size());
}

TEST(SurfaceMesh, box_has_three_vertices_and_three_normals_at_each_corner) {
  const SurfaceMesh mesh = surface_of(make_box_surface(Vec3(0, 0, 0), Vec3(1, 2, 3)));
  EXPECT_EQ(mesh.vertex.size(), 24u);
  for (const SurfaceVertex& v : mesh.vertex)
    EXPECT_NEAR(vec(v.normal).cwiseAbs().maxCoeff(), 1, 1e-6);  // along an axis
}

TEST(SurfaceMesh, creases_are_those_of_the_reference_shape) {
  Sheet sheet = make_sheet(1, 2);
  const std::vector<Vec3> X = sheet.x;
  for (Vec3& p : sheet.x) p.z() = 2 * std::abs(p.x());  // folded by 127 degrees
  const SurfaceMesh folded = make_surface_mesh({.x = sheet.x, .X = X, .triangle = sheet.triangle});
  EXPECT_EQ(folded.vertex.size(), X.size());
  std::vector<Vec3> bent = X;
  for (Vec3& p : bent) p.z() = 0.1 * std::abs(p.x());
  const SurfaceMesh creased =
      make_surface_mesh({.x = bent, .X = sheet.x, .triangle = sheet.triangle});
  EXPECT_EQ(creased.vertex.size(), X.size() + 3);  // the three nodes of the fold
}

TEST(SurfaceMesh, vertices_split_where_outer_surface_and_cut_face_meet) {
  Sheet sheet = make_sheet(1, 4);
  for (std::size_t t = 0; t < sheet.is_cut.size() / 2; ++t) sheet.is_cut[t] = 1;
  const SurfaceMesh mesh = make_surface_mesh(
      {.x = sheet.x, .X = sheet.x, .triangle = sheet.triangle, .is_cut = sheet.is_cut});
  EXPECT_EQ(mesh.vertex.size(), sheet.x.size() + 5);
  for (std::size_t k = 0; k < mesh.index.size(); ++k) {
    const SurfaceVertex& v = mesh.vertex[mesh.index[k]];
    EXPECT_EQ(v.mark[0] != 0, sheet.is_cut[k / 3] != 0);
    EXPECT_EQ(v.mark[1] != 0, v.x[1] == 0.0f);
  }
}

TEST(SurfaceMesh, vertices_split_where_colours_meet_and_the_surface_stays_smooth) {
  Sheet sheet = make_sheet(1, 4);
  for (Vec3& x : sheet.x) x.z() = 0.1 * x.y() * x.y();
  const SurfaceShape shape{.x = sheet.x, .X = sheet.x, .triangle = sheet.triangle};
  const SurfaceMesh of_one = make_surface_mesh(shape);
  SurfaceShape of_two = shape;
  std::vector<Vec3> colour(sheet.triangle.size(), Vec3(1, 0, 0));
  std::fill_n(colour.begin(), colour.size() / 2, Vec3(0, 0, 1));
  of_two.colour = colour;
  const SurfaceMesh mesh = make_surface_mesh(of_two);
  EXPECT_EQ(mesh.vertex.size(), of_one.vertex.size() + 5);
  for (std::size_t k = 0; k < mesh.index.size(); ++k) {
    const SurfaceVertex& v = mesh.vertex[mesh.index[k]];
    EXPECT_EQ(vec(v.colour), colour[k / 3]);
    EXPECT_EQ(v.normal, of_one.vertex[of_one.index[k]].normal);
  }
}

// Else a seam would run where regions meet.
TEST(SurfaceMesh, cut_faces_of_two_colours_have_the_normals_of_one) {
  Sheet sheet = make_sheet(1, 4, true);
  for (Vec3& x : sheet.x) x.z() = 0.2 * std::abs(x.y()) + 0.1 * x.x() * x.x();
  const SurfaceShape shape{
      .x = sheet.x, .X = sheet.x, .triangle = sheet.triangle, .is_cut = sheet.is_cut};
  SurfaceShape of_two = shape;
  std::vector<Vec3> colour(sheet.triangle.size(), Vec3(1, 0, 0));
  std::fill_n(colour.begin(), colour.size() / 2, Vec3(0, 0, 1));
  of_two.colour = colour;
  const SurfaceMesh one = make_surface_mesh(shape), two = make_surface_mesh(of_two);
  ASSERT_EQ(one.index.size(), two.index.size());
  for (std::size_t k = 0; k < one.index.size(); ++k)
    EXPECT_EQ(two.vertex[two.index[k]].normal, one.vertex[one.index[k]].normal);
}

TEST(SurfaceMesh, positions_that_are_not_finite_drop_their_triangles) {
  Sheet sheet = make_sheet(1, 2);
  sheet.x[4].y() = std::numeric_limits<double>::quiet_NaN();  // the middle: two triangles are left
  const SurfaceMesh mesh =
      make_surface_mesh({.x = sheet.x, .X = sheet.x, .triangle = sheet.triangle});
  EXPECT_EQ(mesh.index.size(), 6u);
  for (const SurfaceVertex& v : mesh.vertex) EXPECT_TRUE(vec(v.x).allFinite());
}

TEST(SurfaceMesh, flat_triangles_get_a_unit_normal) {
  const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const Triangles triangle = {{0, 1, 2}};
  for (const SurfaceVertex& v : make_surface_mesh({.x = x, .X = x, .triangle = triangle}).vertex)
    EXPECT_NEAR(vec(v.normal).norm(), 1, 1e-6);
}

TEST(SurfaceRefine, four_times_the_triangles_lie_nearer_to_the_ball) {
  const SurfaceMesh coarse = surface_of(make_sphere_surface(Vec3::Zero(), 1, 16));
  const SurfaceMesh fine = refine_surface_mesh(coarse);
  EXPECT_EQ(fine.index.size(), 4 * coarse.index.size());
  // A chord of length e lies e^2 / 8 below the ball; e <= 2 pi / 16 makes 0.019. The curve leaves
  // less than a quarter of it.
  for (std::size_t v = coarse.vertex.size(); v < fine.vertex.size(); ++v)
    EXPECT_NEAR(vec(fine.vertex[v].x).norm(), 1, 0.25 * 0.019 + 0.01);
  double error = 0, chord_error = 0;
  for (std::size_t k = 0; k < coarse.index.size(); ++k) {
    const Vec3 a = vec(coarse.vertex[coarse.index[k]].x),
               b = vec(coarse.vertex[coarse.index[k % 3 == 2 ? k - 2 : k + 1]].x);
    chord_error += 1 - (0.5 * (a + b)).norm();
  }
  for (std::size_t v = coarse.vertex.size(); v < fine.vertex.size(); ++v)
    error += std::abs(1 - vec(fine.vertex[v].x).norm());
  chord_error /= static_cast<double>(coarse.index.size());
  error /= static_cast<double>(fine.vertex.size() - coarse.vertex.size());
  EXPECT_LT(error, 0.25 * chord_error);
}

TEST(SurfaceRefine, flat_box_stays_flat_and_closed) {
  const SurfaceMesh fine = refine_surface_mesh(
      refine_surface_mesh(surface_of(make_box_surface(Vec3::Zero(), Vec3::Ones()))));
  EXPECT_TRUE(is_closed(fine));
  for (const SurfaceVertex& v : fine.vertex) {
    const Vec3 from_middle = (vec(v.x) - Vec3::Constant(0.5)).cwiseAbs();
    EXPECT_NEAR(from_middle.maxCoeff(), 0.5, 1e-6);
  }
}

TEST(SurfaceRefine, rim_of_a_cut_shows_no_gap) {
  const Mesh ball = make_ball(Vec3::Zero(), 1, 6, BoxElements::tet4_kuhn);
  const Surface surface = boundary_surface(ball);
  std::vector<std::uint8_t> is_cut;
  for (const auto& t : surface.triangle) is_cut.push_back(ball.X[t[0]].z() > 0.3);
  const SurfaceMesh mesh =
      make_surface_mesh({.x = ball.X, .X = ball.X, .triangle = surface.triangle, .is_cut = is_cut});
  EXPECT_GT(mesh.vertex.size(), surface.node.size());
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_TRUE(is_closed(refine_surface_mesh(mesh)));
}

TEST(SurfaceEdges, hexahedra_show_quads_and_tetrahedra_triangles) {
  const Surface hexes =
      boundary_surface(make_box(Vec3::Zero(), Vec3::Ones(), {3, 3, 3}, BoxElements::hex8));
  const Surface tets =
      boundary_surface(make_box(Vec3::Zero(), Vec3::Ones(), {3, 3, 3}, BoxElements::tet4_kuhn));
  for (const std::uint8_t is_half : tets.is_quad_half) EXPECT_EQ(is_half, 0);
  ASSERT_EQ(hexes.is_quad_half.size(), hexes.triangle.size());
  for (std::size_t t = 0; t < hexes.triangle.size(); t += 2) {
    EXPECT_TRUE(hexes.is_quad_half[t] && hexes.is_quad_half[t + 1]);
    EXPECT_EQ(hexes.triangle[t][0], hexes.triangle[t + 1][0]);
    EXPECT_EQ(hexes.triangle[t][2], hexes.triangle[t + 1][1]);
  }
}

TEST(SurfaceEdges, a_quad_among_triangles_hides_its_own_diagonal_alone) {
  const Sheet sheet = make_sheet(1, 2);
  const SurfaceMesh mesh =
      make_surface_mesh({.x = sheet.x, .X = sheet.x, .triangle = sheet.triangle});
  const std::vector<std::uint8_t> middle = {0, 0, 1, 1, 0, 0, 0, 0};
  const SurfaceMesh marked = mark_edges(mesh, middle);
  ASSERT_EQ(marked.vertex.size(), 24u);
  for (int k = 0; k < 24; ++k)
    for (int c = 0; c < 3; ++c) {
      const bool is_diagonal = (k / 3 == 2 && c == 1) || (k / 3 == 3 && c == 2);
      EXPECT_EQ(marked.vertex[k].edge[c], is_diagonal || c == k % 3 ? 255 : 0) << k;
    }
}

TEST(SurfaceEdges, each_triangle_has_its_own_vertices_and_the_diagonal_is_hidden) {
  const Sheet sheet = make_sheet(1, 1);
  const SurfaceMesh mesh =
      make_surface_mesh({.x = sheet.x, .X = sheet.x, .triangle = sheet.triangle});
  const std::vector<std::uint8_t> both = {1, 1};
  const SurfaceMesh plain = mark_edges(mesh, {}), quad = mark_edges(mesh, both);
  EXPECT_EQ(plain.vertex.size(), 6u);
  // Distance from edge c is 0 at the two corners other than c; a hidden edge is far from
  // everywhere.
  for (int k = 0; k < 6; ++k)
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(plain.vertex[k].edge[c], c == k % 3 ? 255 : 0);
      const bool is_diagonal = c == (k < 3 ? 1 : 2);
      EXPECT_EQ(quad.vertex[k].edge[c], is_diagonal || c == k % 3 ? 255 : 0);
    }
}

TEST(SurfaceRefine, for_an_eye_only_edges_near_the_outline_are_split_and_no_gap_opens) {
  const SurfaceMesh coarse = surface_of(make_sphere_surface(Vec3::Zero(), 1, 32));
  const Vec3 eye(0, 0, 4);
  const SurfaceMesh fine = refine_surface_mesh(coarse, &eye);
  EXPECT_TRUE(is_closed(fine));
  EXPECT_GT(fine.index.size(), coarse.index.size());
  EXPECT_LT(fine.index.size(), 2.5 * coarse.index.size());
  for (std::size_t v = coarse.vertex.size(); v < fine.vertex.size(); ++v) {
    // An end of the edge is seen at a cosine below 0.3, its other end at most an edge further:
    // seen from four radii the angle changes by less than twice the edge's 2 pi / 32.
    const Vec3 x = vec(fine.vertex[v].x);
    EXPECT_LT(std::abs(x.dot((eye - x).normalized())), 0.3 + 2 * 0.2);
  }
  // Where the outline runs the new vertices are as near to the ball as those of the whole.
  const SurfaceMesh whole = refine_surface_mesh(coarse);
  const auto points_at_outline = [&](const SurfaceMesh& mesh) {
    int n = 0;
    for (std::size_t v = coarse.vertex.size(); v < mesh.vertex.size(); ++v)
      if (const Vec3 x = vec(mesh.vertex[v].x); std::abs(x.dot((eye - x).normalized())) < 0.05) ++n;
    return n;
  };
  EXPECT_GT(points_at_outline(whole), 0);
  EXPECT_EQ(points_at_outline(fine), points_at_outline(whole));
}
