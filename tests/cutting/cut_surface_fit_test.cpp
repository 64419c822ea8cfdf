#include "cutting/cut_surface_fit.h"

#include <gtest/gtest.h>

#include <random>

namespace trocar {
namespace {

TEST(FitSurface, is_exact_on_a_plane) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  const Vec3 N = Vec3(1, 2, -0.5).normalized(), along = N.unitOrthogonal();
  std::vector<SurfacePoint> points;
  for (int k = 0; k < 12; ++k)
    points.push_back({0.3 * N + u(random) * along + u(random) * N.cross(along), N});
  const Vec3 X(0.4, -0.7, 0.2);
  const SurfacePlane plane = fit_surface(points, X, 0.5);
  EXPECT_NEAR(plane.distance(X), N.dot(X) - 0.3, 1e-14);  // rounding
  EXPECT_NEAR((plane.N - N).norm(), 0, 1e-14);
}

TEST(FitSurface, follows_a_sphere_to_second_order) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-1, 1);
  constexpr double h = 0.1, R = 1;
  std::vector<SurfacePoint> points;
  for (int k = 0; k < 60; ++k) {
    const Vec3 N = Vec3(h * u(random), h * u(random), 1).normalized();
    points.push_back({R * N, N});
  }
  const Vec3 X(0, 0, R + 0.5 * h);
  // Tangent planes of points at distance r are off by r^2/2R, at most h^2 here.
  EXPECT_NEAR(fit_surface(points, X, h).distance(X), 0.5 * h, h * h);
}

}  // namespace
}  // namespace trocar
