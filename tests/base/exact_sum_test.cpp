#include "base/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace trocar {
namespace {

double sum_of(const std::vector<double>& values) {
  return exact_sum(values);
}

TEST(ExactSum, keeps_what_plain_summation_cancels) {
  EXPECT_EQ(sum_of({1e20, 1.0, -1e20}), 1.0);
  EXPECT_EQ(sum_of({1e-20, 1e15, -1e15}), 1e-20);
  EXPECT_EQ(sum_of({-0.375, 0.125}), -0.25);
  EXPECT_EQ(sum_of({}), 0.0);
}

TEST(ExactSum, is_the_same_in_any_order) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> digits(-1, 1), exponent(-60, 60);
  std::vector<double> values(5000);
  for (double& value : values)
    value = std::ldexp(digits(random), static_cast<int>(exponent(random)));
  const double first = sum_of(values);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(values.begin(), values.end(), random);
    EXPECT_EQ(sum_of(values), first);
  }
}

TEST(ExactSum, agrees_with_long_double_summation_to_its_rounding) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> digits(-1, 1);
  std::vector<double> values(1000);
  for (double& value : values) value = digits(random);
  long double sum = 0;
  for (const double value : values) sum += value;
  // 1000 additions of numbers below 1 in 64-bit mantissas: error below 1000 * 2^-64 * 1000.
  EXPECT_NEAR(sum_of(values), static_cast<double>(sum), 1e-13);
}

TEST(ExactSum, with_an_addend_that_is_too_large_is_infinite) {
  EXPECT_TRUE(std::isinf(sum_of({1.0, 0x1p200, -0x1p200})));
  EXPECT_EQ(sum_of({1.0, 0x1p120, -0x1p120}), 1.0);
  for (const double endless :
       {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(std::isinf(sum_of({1.0, endless})));
}

TEST(ExactSum, of_vectors_are_told_in_their_order) {
  std::vector<ExactSum3> sums(2);
  for (int k = 0; k < 3; ++k) {
    add(Vec3(1, 2, 3), sums[0]);
    add(Vec3(-1, 0, k), sums[1]);
  }
  const Communicator alone;
  EXPECT_EQ(sum_over_ranks(sums, alone), std::vector({Vec3(3, 6, 9), Vec3(-3, 0, 3)}));
  EXPECT_TRUE(sum_over_ranks(std::span<const ExactSum3>(), alone).empty());
}

}  // namespace
}  // namespace trocar
