// Powers of J and eigenvalues without libm, against libm and Eigen.
#include "solver/isochoric.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "solver/symmetric_eigenvalues.h"
#include "solver_algebra.h"
#include "solver_body.h"

using namespace trocar;

// A few roundings of 1.1e-16 each; expm1 and log1p have no cancellation either.
constexpr double rounding = 12 * 1.2e-16;
// What goes into the last correction is off by 3e-11, of which a few roundings are left.
constexpr double absolute_error = 4e-26;

// Near J = 0, j = J - 1 itself is only known to eps / J; far above 1 the last correction
// subtracts numbers of size J.
static double condition(double J) {
  return std::max(std::abs(J), 1 / std::abs(J));
}

TEST(Isochoric, q_is_relatively_exact_from_tiny_to_huge_volume_changes) {
  for (double magnitude = 1e-12; magnitude < 1e3; magnitude *= 1.37)
    for (const double j : {magnitude, -magnitude}) {
      if (1 + j < volume_floor) continue;
      const double q = std::expm1(-2.0 / 3 * std::log1p(j));
      const double tolerance = rounding * condition(1 + j) * std::abs(q);
      EXPECT_NEAR(isochoric(j).q, q, tolerance + absolute_error) << "j = " << j;
    }
}

TEST(Isochoric, inverse_is_one_over_J_above_the_floor) {
  for (const double J : {0.2001, 0.9, 1.0, 1.1, 7.99, 8.01, 1e3}) {
    EXPECT_NEAR(isochoric(J - 1).inverse * J, 1, rounding * condition(J)) << J;
    EXPECT_EQ(isochoric(J - 1).extended, 0) << J;
  }
}

TEST(Isochoric, below_the_floor_one_over_J_goes_on_as_its_taylor_polynomial) {
  constexpr double J0 = volume_floor;
  for (const double J : {.19, .1, 1e-9, 0., -1e-9, -.072, -1., -30.}) {
    // 1/J, -1/J^2, 2/J^3 at J0
    const double y = 1 / J0 - (J - J0) / (J0 * J0) + (J - J0) * (J - J0) / (J0 * J0 * J0);
    const double dy = -1 / (J0 * J0) + 2 * (J - J0) / (J0 * J0 * J0);
    const Isochoric<double> iso = isochoric(J - 1);
    EXPECT_NEAR((1 + iso.q) / std::pow(y, 2. / 3), 1, 3 * rounding) << J;
    EXPECT_NEAR(iso.inverse * y / -dy, 1, 3 * rounding) << J;
    EXPECT_NEAR(iso.extended, 1 + J * dy / y, 10 * rounding) << J;  // of numbers of order 1
  }
}

TEST(Isochoric, vanishes_without_volume_change) {
  EXPECT_NEAR(isochoric(0.0).q, 0, absolute_error);
}

TEST(SymmetricEigenvalues, are_those_that_the_tensor_was_made_of_the_largest_first) {
  Noise noise(1);
  for (int k = 0; k < 2000; ++k) {
    const Mat3 Q = random_orthogonal(noise);
    // Also double and triple eigenvalues, where the cubic's derivative vanishes.
    Vec3 d = random_eigenvalues(k, noise);
    const Mat3 A = Q * d.asDiagonal() * Q.transpose();
    const SymmetricTensor<double> S = {{A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(2, 0)}};
    // Double roots are known to sqrt(eps) only.
    const double tolerance = k % 4 == 0 ? 1e-9 : 1e-7;
    EXPECT_NEAR(largest_eigenvalue(S), d.maxCoeff(), tolerance);
    double value[3];
    find_eigenvalues(S, value);
    std::ranges::sort(d, std::greater());
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], d[i], tolerance) << d.transpose();
  }
}
