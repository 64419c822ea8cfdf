#include "cutting/cut_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "cutting/cut_patch.h"

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

void add_at(const std::vector<Vec3>& X, int a, NodeEnergy& energy) {
  const std::array<int, 3>& c = tet_facets[std::size_t(a)];
  const TetAtNode tet{tet_shape(X, corners),
                      {&X[std::size_t(c[0])], &X[std::size_t(c[1])], &X[std::size_t(c[2])]}};
  add_squared_bounds(X[std::size_t(a)], {&tet, 1}, 0.8, energy);
}

// In place of pairs of them.
TEST(SquaredBound, of_several_tetrahedra_is_that_of_each_to_the_last_bit) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> shift(-0.15, 0.15);
  std::vector<std::vector<Vec3>> X(5, regular_tetrahedron());
  std::vector<TetAtNode> tets;
  for (std::vector<Vec3>& x : X) {
    for (std::size_t k = 1; k < 4; ++k) x[k] += Vec3(shift(random), shift(random), shift(random));
    tets.push_back({tet_shape(x, corners), {&x[3], &x[2], &x[1]}});
  }
  for (std::size_t n = 1; n <= tets.size(); ++n) {
    NodeEnergy together, one_by_one;
    add_squared_bounds(X[0][0], std::span(tets).first(n), 0.8, together);
    for (std::size_t k = 0; k < n; ++k) add_squared_bounds(X[0][0], {&tets[k], 1}, 0.8, one_by_one);
    EXPECT_EQ(together.value, one_by_one.value);
    EXPECT_EQ(together.gradient, one_by_one.gradient);
    EXPECT_EQ(together.hessian, one_by_one.hessian);
  }
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
      add_at(X, a, energy);
      EXPECT_NEAR(energy.value, squared_bound(X, 0.8), 1e-13 * energy.value);  // rounding
      for (int k = 0; k < 3; ++k) {
        std::vector<Vec3> plus = X, minus = X;
        plus[std::size_t(a)][k] += d;
        minus[std::size_t(a)][k] -= d;
        NodeEnergy high, low;
        add_at(plus, a, high);
        add_at(minus, a, low);
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
