#include "base/reproducible_dot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "base/exact_sum.h"
#include "base/threads.h"

namespace trocar {
namespace {

const Communicator alone;

double largest_product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> products(a.size());
  std::transform(a.begin(), a.end(), b.begin(), products.begin(), std::multiplies<>());
  return largest_size(products);
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return reproducible_dot(a, b, static_cast<std::int64_t>(a.size()), largest_product(a, b), alone);
}

// Sizes over 60 powers of two, both signs.
std::vector<double> random_vector(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> digits(-1, 1), exponent(-60, 0);
  std::vector<double> values(n);
  for (double& value : values)
    value = std::ldexp(digits(random), static_cast<int>(exponent(random)));
  return values;
}

TEST(ReproducibleDot, agrees_with_an_exact_sum_of_the_products) {
  for (const std::size_t n : {1U, 3U, 4U, 1001U, 300000U}) {
    const std::vector<double> a = random_vector(n, 1), b = random_vector(n, 2);
    ExactSum sum;
    for (std::size_t k = 0; k < n; ++k) sum.add(a[k] * b[k]);
    const double n3 = std::pow(static_cast<double>(n), 3);
    EXPECT_NEAR(dot(a, b), sum.value(),
                12 * n3 * 0x1p-104 * largest_product(a, b) + 1e-16 * std::abs(sum.value()));
  }
}

TEST(ReproducibleDot, has_the_same_bits_in_any_order) {
  const std::size_t n = 5003;
  const std::vector<double> a = random_vector(n, 3), b = random_vector(n, 4);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(5);
  std::set<double> plain, reproducible;
  for (int k = 0; k < 6; ++k, std::shuffle(order.begin(), order.end(), random)) {
    std::vector<double> shuffled_a, shuffled_b;
    for (const std::size_t i : order) {
      shuffled_a.push_back(a[i]);
      shuffled_b.push_back(b[i]);
    }
    plain.insert(std::inner_product(shuffled_a.begin(), shuffled_a.end(), shuffled_b.begin(), 0.0));
    reproducible.insert(dot(shuffled_a, shuffled_b));
  }
  EXPECT_EQ(reproducible.size(), 1U);
  EXPECT_GT(plain.size(), 1U) << "these numbers prove nothing";
}

// Of tiny products an ExactSum cuts sums off, one sooner than the other by who has summed what.
TEST(ReproducibleDot, of_tiny_numbers_has_the_same_bits_on_any_threads_and_as_of_large_ones) {
  std::vector<double> a = random_vector(5003, 8), b = random_vector(5003, 9);
  const double large = dot(a, b);
  for (double& value : a) value = std::ldexp(value, -96);
  for (double& value : b) value = std::ldexp(value, -32);
  for (const int n_threads : {1, 2, 3, 7}) {
    set_thread_count(n_threads);
    EXPECT_EQ(dot(a, b), std::ldexp(large, -128)) << n_threads;
  }
  set_thread_count(1);
}

TEST(ReproducibleDot, has_the_same_bits_on_any_threads) {
  const std::vector<double> a = random_vector(5003, 6), b = random_vector(5003, 7);
  const double alone_on_it = dot(a, b);
  for (const int n_threads : {2, 3, 7}) {
    set_thread_count(n_threads);
    EXPECT_EQ(dot(a, b), alone_on_it);
  }
  set_thread_count(1);
}

TEST(LargestSize, is_that_of_either_sign_wherever_it_stands) {
  for (std::size_t n = 1; n < 20; ++n)
    for (std::size_t at = 0; at < n; ++at)
      for (const double largest : {-3.0, 3.0}) {
        std::vector<double> x(n, 1.0);
        x[at] = largest;
        EXPECT_EQ(largest_size(x), 3);
      }
  EXPECT_EQ(largest_size({}), 0);
}

TEST(ReproducibleDot, of_nothing_is_zero_and_of_infinities_not_a_number) {
  EXPECT_EQ(dot({}, {}), 0);
  EXPECT_EQ(dot({0, 0}, {1, 2}), 0);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {infinite, -infinite, std::numeric_limits<double>::quiet_NaN()})
    for (std::size_t at = 0; at < 6; ++at) {
      std::vector<double> a(6, 1.0);
      a[at] = bad;
      EXPECT_TRUE(std::isnan(dot(a, std::vector<double>(6, 2.0)))) << bad << at;
    }
}

// Each product is finite, as many as there are may not be.
TEST(ReproducibleDot, of_what_may_sum_beyond_all_numbers_is_not_a_number) {
  const std::vector<double> a(1000, 1e153);
  EXPECT_TRUE(std::isnan(dot(a, a)));
  EXPECT_NEAR(dot({1e153}, {1e153}) / 1e306, 1, 1e-15);
}

}  // namespace
}  // namespace trocar
