// Logarithm, exponential and eigenvectors of packs, against libm and by definition.
#include "solver/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "larger_or_nan.h"
#include "solver/symmetric_eigen.h"
#include "solver_algebra.h"
#include "solver_body.h"

using namespace trocar;

using Single = PackOf<float, 1>;

// Relative to the largest of: the value; eps stands for two to four roundings.
template <class Function, class Exact>
static double worst_error(const Function& function, const Exact& exact, double low, double high) {
  double worst = 0;
  for (double size = 1e-9; size < 1e3; size *= 1.0137)
    for (const double x : {size, -size}) {
      if (x <= low || x >= high) continue;
      const double y = function(x);
      worst = larger_or_nan(worst, std::abs(y - exact(x)) / std::abs(exact(x)));
    }
  return worst;
}

TEST(Elementary, log1p_has_all_digits_from_tiny_to_large) {
  const auto in_double = [](double x) { return log1p_of(x); };
  EXPECT_LT(worst_error(
                in_double, [](double x) { return std::log1p(x); }, -.999999, 1e3),
            1e-15);
  const auto in_single = [](double x) {
    return static_cast<double>(log1p_of(Single{static_cast<float>(x)})[0]);
  };
  const auto exact = [](double x) { return std::log1p(double{static_cast<float>(x)}); };
  EXPECT_LT(worst_error(in_single, exact, -.999, 1e3), 4e-7);  // four roundings of 6e-8 to 1.2e-7
}

TEST(Elementary, expm1_has_all_digits_from_tiny_to_large) {
  const auto in_double = [](double x) { return expm1_of(x); };
  EXPECT_LT(worst_error(
                in_double, [](double x) { return std::expm1(x); }, -600, 600),
            1e-15);
  const auto in_single = [](double x) {
    return static_cast<double>(expm1_of(Single{static_cast<float>(x)})[0]);
  };
  const auto exact = [](double x) { return std::expm1(double{static_cast<float>(x)}); };
  EXPECT_LT(worst_error(in_single, exact, -80, 80), 4e-7);
}

TEST(Elementary, keeps_a_NaN_and_stays_finite_at_the_ends) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(log1p_of(nan)));
  EXPECT_TRUE(std::isnan(expm1_of(nan)));
  EXPECT_TRUE(std::isfinite(log1p_of(-1.0)));
  EXPECT_TRUE(std::isfinite(expm1_of(1e9)));
  EXPECT_EQ(expm1_of(0.0), 0);
  EXPECT_EQ(log1p_of(0.0), 0);
}

// A = sum value vector (x) vector and orthonormal vectors, also where eigenvalues are equal.
TEST(SymmetricEigen, gives_back_its_tensor_from_orthonormal_vectors) {
  Noise noise(1);
  for (int k = 0; k < 2000; ++k) {
    const Mat3 Q = random_orthogonal(noise);
    const Vec3 d = k % 16 == 7 ? Vec3(1, 1e-8, -1e-14) : random_eigenvalues(k, noise);
    const Mat3 A = k % 16 == 11 ? Mat3(d.asDiagonal()) : Mat3(Q * d.asDiagonal() * Q.transpose());
    SymmetricEigen<double> eigen;
    find_eigen(SymmetricTensor<double>{{A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(2, 0)}},
               eigen);
    Mat3 V;
    Vec3 value;
    for (int i = 0; i < 3; ++i) {
      value[i] = eigen.value[i];
      for (int j = 0; j < 3; ++j) V(j, i) = eigen.vector[i][j];
    }
    const double tolerance = 60 * 1.1e-16;  // fifteen rotations of four roundings each
    EXPECT_LT((V.transpose() * V - Mat3::Identity()).norm(), tolerance);
    EXPECT_LT((V * value.asDiagonal() * V.transpose() - A).norm(), tolerance * d.norm());
  }
}
