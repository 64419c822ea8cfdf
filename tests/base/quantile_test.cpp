#include "base/quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace trocar {
namespace {

// By definition: the least value that at least the share q of all values do not exceed.
double least_value_above_share(const std::vector<double>& values, double share) {
  double least = *std::max_element(values.begin(), values.end());
  for (const double value : values) {
    const auto n =
        std::count_if(values.begin(), values.end(), [&](double other) { return other <= value; });
    if (static_cast<double>(n) >= share * static_cast<double>(values.size()) - 1e-9)
      least = std::min(least, value);
  }
  return least;
}

TEST(Quantile, is_the_least_value_that_the_share_does_not_exceed) {
  std::mt19937 random(1);
  for (const std::size_t n : {1u, 2u, 3u, 10u, 99u, 100u, 101u, 1000u}) {
    std::vector<double> values(n);
    for (double& value : values) value = static_cast<double>(random() % 500);
    for (const double q : {0.0, 0.01, 0.25, 0.5, 0.75, 0.99, 0.999, 1.0})
      EXPECT_EQ(quantile(values, q), least_value_above_share(values, q))
          << n << " values, q = " << q;
  }
}

TEST(Quantile, of_the_numbers_up_to_a_hundred_is_the_percentage) {
  std::vector<double> values;
  for (int k = 100; k >= 1; --k) values.push_back(k);
  for (int percent = 1; percent <= 100; ++percent)
    EXPECT_EQ(quantile(values, percent / 100.0), percent);
}

TEST(Quantile, of_no_values_is_zero) {
  EXPECT_EQ(quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace trocar
