#include "collision/surface_tree.h"

#include <cmath>
#include <limits>

#include "collision_random.h"
#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

struct Ball {
  Mesh mesh = make_ball(Vec3(0.1, 0, 0), 0.03, 8, BoxElements::tet4_kuhn);
  Surface surface = boundary_surface(mesh);
};

Triangle corners_of(const Ball& ball, std::size_t t) {
  const auto& node = ball.surface.triangle[t];
  return {ball.mesh.X[node[0]], ball.mesh.X[node[1]], ball.mesh.X[node[2]]};
}

// Sum of the solid angles of all triangles over 4 pi (van Oosterom and Strackee 1983).
double winding_by_solid_angles(const Ball& ball, const Vec3& p) {
  double sum = 0;
  for (std::size_t t = 0; t < ball.surface.triangle.size(); ++t) {
    const Triangle x = corners_of(ball, t);
    const Vec3 a = x[0] - p, b = x[1] - p, c = x[2] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * M_PI);
}

TEST(SurfaceTree, finds_the_triangles_whose_box_overlaps_like_a_plain_loop) {
  const Ball ball;
  const SurfaceTree tree(ball.surface.triangle, ball.mesh.X);
  Random random(1);
  std::vector<std::int32_t> found;
  for (int k = 0; k < 300; ++k) {
    Box box;
    box.add(Vec3(Vec3(0.1, 0, 0) + random.in_box(0.04)));
    box.add(Vec3(box.low + random.in_box(0.01)));
    std::vector<std::int32_t> expected;
    for (std::size_t t = 0; t < ball.surface.triangle.size(); ++t) {
      Box own;
      for (const Vec3& x : corners_of(ball, t)) own.add(x);
      if (own.overlaps(box)) expected.push_back(static_cast<std::int32_t>(t));
    }
    tree.overlapping(box, found);
    EXPECT_EQ(found, expected);
  }
}

TEST(SurfaceTree, winding_number_is_the_sum_of_solid_angles) {
  const Ball ball;
  const SurfaceTree tree(ball.surface.triangle, ball.mesh.X);
  Random random(2);
  int n_inside = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = Vec3(0.1, 0, 0) + random.in_box(0.032);
    const int winding = tree.winding_number(p);
    // The sum is an integer up to rounding, unless p lies on the surface.
    EXPECT_NEAR(winding_by_solid_angles(ball, p), winding, 1e-9);
    n_inside += winding;
  }
  EXPECT_GT(n_inside, 100);
  EXPECT_LT(n_inside, 400);
}

TEST(SurfaceTree, winding_number_survives_rays_through_vertices_and_edges) {
  const Mesh mesh = make_box(Vec3(-1, -1, -1), Vec3(1, 1, 1), {4, 4, 4}, BoxElements::tet4_five);
  const SurfaceTree tree(boundary_surface(mesh).triangle, mesh.X);
  // Multiples of a quarter cell: many rays meet vertices, edges and diagonals head on.
  for (double x = -0.875; x < 1; x += 0.125)
    for (double y = -0.875; y < 1; y += 0.125) {
      EXPECT_EQ(tree.winding_number(Vec3(x, y, 0.25)), 1) << x << ' ' << y;
      EXPECT_EQ(tree.winding_number(Vec3(x, y, -1.25)), 0) << x << ' ' << y;
      EXPECT_EQ(tree.winding_number(Vec3(x, y, 1.25)), 0) << x << ' ' << y;
    }
}

TEST(SurfaceTree, winding_number_is_two_where_the_surface_overlaps_itself) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {1, 1, 1}, BoxElements::tet4_five);
  std::vector<std::array<std::int32_t, 3>> triangles = boundary_surface(mesh).triangle;
  const std::size_t n = triangles.size();
  const std::int32_t n_nodes = mesh.n_nodes();
  for (std::size_t t = 0; t < n; ++t) {
    triangles.push_back(triangles[t]);
    for (std::int32_t& i : triangles.back()) i += n_nodes;
  }
  for (std::int32_t i = 0; i < n_nodes; ++i) mesh.X.push_back(mesh.X[i] + Vec3(0.5, 0, 0));
  const SurfaceTree tree(triangles, mesh.X);
  EXPECT_EQ(tree.winding_number(Vec3(0.7, 0.4, 0.3)), 2);
  EXPECT_EQ(tree.winding_number(Vec3(0.3, 0.4, 0.3)), 1);
  EXPECT_EQ(tree.winding_number(Vec3(1.2, 0.4, 0.3)), 1);
}

TEST(SurfaceTree, nearest_exit_is_that_of_a_plain_loop) {
  const Ball ball;
  const SurfaceTree tree(ball.surface.triangle, ball.mesh.X);
  Random random(3);
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = Vec3(0.1, 0, 0) + random.in_box(0.03);
    double nearest = std::numeric_limits<double>::max();
    std::int32_t expected = -1;
    for (std::size_t t = 0; t < ball.surface.triangle.size(); ++t) {
      const Triangle x = corners_of(ball, t);
      const Vec3 d = closest_point_triangle(p, x).point - p;
      if (d.dot((x[1] - x[0]).cross(x[2] - x[0])) <= 0 || d.squaredNorm() >= nearest) continue;
      nearest = d.squaredNorm();
      expected = static_cast<std::int32_t>(t);
    }
    EXPECT_EQ(tree.nearest_exit(p, 1.0), expected);
    EXPECT_EQ(tree.nearest_exit(p, 0.999 * std::sqrt(nearest)), -1);
  }
}

TEST(SurfaceTree, refitted_answers_like_one_built_anew) {
  const Ball ball;
  std::vector<Vec3> x = ball.mesh.X;
  SurfaceTree refitted(ball.surface.triangle, x);
  Random random(4);
  for (Vec3& p : x) p = Vec3(p.y(), 3 * p.x(), p.z()) + random.in_box(0.0005);
  refitted.refit(x);
  const SurfaceTree anew(ball.surface.triangle, x);
  std::vector<std::int32_t> a, b;
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = Vec3(0, 0.3, 0) + random.in_box(0.05);
    Box box;
    box.add(p);
    box.add(Vec3(p + random.in_box(0.02)));
    refitted.overlapping(box, a);
    anew.overlapping(box, b);
    EXPECT_EQ(a, b);
    EXPECT_EQ(refitted.winding_number(p), anew.winding_number(p));
    EXPECT_EQ(refitted.nearest_exit(p, 1), anew.nearest_exit(p, 1));
  }
}

TEST(SurfaceTree, of_no_triangles_finds_nothing) {
  const SurfaceTree tree({}, {});
  std::vector<std::int32_t> found = {7};
  tree.overlapping(Box{.low = Vec3::Constant(-1), .high = Vec3::Constant(1)}, found);
  EXPECT_TRUE(found.empty());
  EXPECT_EQ(tree.winding_number(Vec3::Zero()), 0);
  EXPECT_EQ(tree.nearest_exit(Vec3::Zero(), 1), -1);
}

}  // namespace
}  // namespace trocar
