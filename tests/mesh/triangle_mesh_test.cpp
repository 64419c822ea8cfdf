// Surfaces of instruments' primitives are closed, look outward and have the volume of their
// polygon.
#include "mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "mesh_fixtures.h"

using namespace trocar;

static constexpr double pi = std::numbers::pi;

static void expect_closed(const TriangleMesh& mesh, double volume) {
  EXPECT_TRUE(is_closed(mesh.triangle));
  EXPECT_EQ(euler_characteristic(mesh.triangle), 2);
  EXPECT_NEAR(enclosed_volume(mesh.triangle, mesh.X), volume, 1e-12 * volume);
}

// Area of the regular n-gon in a circle of radius r.
static double polygon_area(int n, double r) {
  return n * r * r * std::sin(2 * pi / n) / 2;
}

TEST(ConeSurface, has_the_volume_of_a_frustum_of_a_pyramid) {
  const Vec3 a(0.1, 0.2, 0.3), b(0.4, -0.1, 0.9);
  for (const int n : {3, 5, 8, 30})
    for (const double radius_b : {0.2, 0.07}) {
      const double A = polygon_area(n, 0.2), B = polygon_area(n, radius_b);
      expect_closed(make_cone_surface(a, b, 0.2, radius_b, n),
                    (b - a).norm() * (A + B + std::sqrt(A * B)) / 3);
    }
}

TEST(ConeSurface, may_end_in_a_point_at_either_end) {
  const Vec3 a(0, 0, 0), b(0, 0, 2);
  expect_closed(make_cone_surface(a, b, 0.3, 0, 7), 2 * polygon_area(7, 0.3) / 3);
  expect_closed(make_cone_surface(a, b, 0, 0.3, 7), 2 * polygon_area(7, 0.3) / 3);
}

// Latitudes k / m of a quarter turn: a stack of frustums of pyramids.
static double half_sphere_volume(int n, int m) {
  double V = 0;
  for (int k = 0; k < m; ++k) {
    const double low = pi / 2 * k / m, high = pi / 2 * (k + 1) / m;
    const double A = polygon_area(n, std::cos(low)), B = polygon_area(n, std::cos(high));
    V += (std::sin(high) - std::sin(low)) * (A + B + std::sqrt(A * B)) / 3;
  }
  return V;
}

TEST(SphereSurface, has_all_vertices_on_the_sphere) {
  const Vec3 centre(0.1, 0.2, -0.3);
  for (const int n : {3, 8, 24}) {
    const TriangleMesh mesh = make_sphere_surface(centre, 0.004, n);
    for (const Vec3& X : mesh.X) EXPECT_NEAR((X - centre).norm(), 0.004, 1e-16);
    expect_closed(mesh, 2 * half_sphere_volume(n, n < 8 ? 2 : n / 4) * std::pow(0.004, 3));
  }
}

TEST(CapsuleSurface, is_a_prism_between_two_half_spheres) {
  const Vec3 a(0.1, 0.2, 0.3), b(0.4, -0.1, 0.9);
  const double r = 0.05;
  for (const int n : {6, 16, 32})
    expect_closed(make_capsule_surface(a, b, r, n),
                  polygon_area(n, r) * (b - a).norm() +
                      2 * half_sphere_volume(n, n < 8 ? 2 : n / 4) * r * r * r);
}

TEST(CapsuleSurface, keeps_its_radius_from_the_axis_segment) {
  const Vec3 a(0.1, 0.2, 0.3), b(0.4, -0.1, 0.9), d = b - a;
  for (const Vec3& X : make_capsule_surface(a, b, 0.05, 16).X) {
    const double s = std::clamp((X - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    EXPECT_NEAR((X - (a + s * d)).norm(), 0.05, 1e-15);
  }
}

TEST(BoxSurface, has_the_volume_and_the_corners_of_the_box) {
  const Vec3 low(-0.1, 0.2, 0.7), high(0.2, 0.4, 0.9);
  const TriangleMesh mesh = make_box_surface(low, high);
  expect_closed(mesh, (high - low).prod());
  ASSERT_EQ(mesh.X.size(), 8U);
  for (const Vec3& X : mesh.X)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(X[k] == low[k] || X[k] == high[k]);
}

TEST(PlateSurface, has_the_volume_of_outline_times_thickness) {
  const std::vector<Vec3> outline = {{0, 0, 1}, {3, 0, 1}, {4, 1, 1}, {2, 3, 1}, {0, 2, 1}};
  // Shoelace: (3*1 - 4*0) + (4*3 - 2*1) + (2*2 - 0*3) = 3 + 10 + 4, halved.
  expect_closed(make_plate_surface(outline, Vec3::UnitZ(), 0.1), 17.0 / 2 * 0.1);
}

TEST(TriangleMesh, append_keeps_both_surfaces) {
  TriangleMesh mesh = make_box_surface(Vec3::Zero(), Vec3::Ones());
  append(mesh, make_box_surface(Vec3(2, 0, 0), Vec3(4, 1, 1)));
  EXPECT_TRUE(is_closed(mesh.triangle));
  EXPECT_EQ(euler_characteristic(mesh.triangle), 4);
  EXPECT_NEAR(enclosed_volume(mesh.triangle, mesh.X), 3, 1e-14);
}

TEST(TriangleMesh, shapes_without_extent_are_refused) {
  const Vec3 o = Vec3::Zero(), x = Vec3::UnitX();
  EXPECT_THROW(make_sphere_surface(o, 0, 8), InputError);
  EXPECT_THROW(make_sphere_surface(o, 1, 2), InputError);
  EXPECT_THROW(make_capsule_surface(o, o, 1, 8), InputError);
  EXPECT_THROW(make_cone_surface(o, x, 0, 0, 8), InputError);
  EXPECT_THROW(make_cone_surface(o, x, -1, 1, 8), InputError);
  EXPECT_THROW(make_box_surface(x, o), InputError);
  EXPECT_THROW(make_plate_surface({o, x}, Vec3::UnitZ(), 1), InputError);
  EXPECT_THROW(make_plate_surface({o, x, Vec3(1, 1, 0)}, Vec3::UnitZ(), 0), InputError);
}
