#include "cutting/cut_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace trocar {
namespace {

constexpr std::array<std::int32_t, 4> corners{0, 1, 2, 3};

std::vector<Vec3> regular_tetrahedron() {
  return {{0, 0, 0},
          {1, 0, 0},
          {0.5, std::sqrt(3.0) / 2, 0},
          {0.5, std::sqrt(3.0) / 6, std::sqrt(2.0 / 3)}};
}

double squared_bound(const std::vector<Vec3>& X, double h) {
  const double f = stability_bound(X, corners, h);
  return f * f;
}

TEST(StabilityBound, is_one_for_the_regular_tetrahedron) {
  EXPECT_NEAR(stability_bound(regular_tetrahedron(), corners, 1), 1, 1e-14);  // rounding
}

TEST(StabilityBound, is_infinite_without_volume) {
  std::vector<Vec3> X = regular_tetrahedron();
  X[3].z() = 0;
  EXPECT_TRUE(std::isinf(stability_bound(X, corners, 1)));
}

TEST(SquaredBound, has_the_gradient_and_hessian_of_finite_differences) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.15, 0.15);
  constexpr double d = 1e-5;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec3> X = regular_tetrahedron();
    for (Vec3& p : X) p += Vec3(shift(random), shift(random), shift(random));
    for (int a = 0; a < 4; ++a) {
      NodeEnergy energy;
      add_squared_bound(X, corners, a, 0.8, energy);
      EXPECT_NEAR(energy.value, squared_bound(X, 0.8), 1e-13 * energy.value);  // rounding
      for (int k = 0; k < 3; ++k) {
        std::vector<Vec3> plus = X, minus = X;
        plus[std::size_t(a)][k] += d;
        minus[std::size_t(a)][k] -= d;
        NodeEnergy high, low;
        add_squared_bound(plus, corners, a, 0.8, high);
        add_squared_bound(minus, corners, a, 0.8, low);
        const double slope = (high.value - low.value) / (2 * d);
        const Vec3 curvature = (high.gradient - low.gradient) / (2 * d);
        // Central differences err by d^2 times the third derivative, of the order of 1e3 here.
        EXPECT_NEAR(energy.gradient[k], slope, 1e-6 * (1 + std::abs(slope)));
        EXPECT_LT((energy.hessian.col(k) - curvature).norm(), 1e-6 * (1 + curvature.norm()));
      }
    }
  }
}

}  // namespace
}  // namespace trocar
