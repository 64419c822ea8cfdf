// The least of many values against a look at all of them.
#include "base/least_of_many.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace trocar;

TEST(LeastOfMany, follows_values_that_change_in_any_block) {
  for (const std::int64_t n : {1, 7, 511, 512, 513, 3001}) {
    std::vector<double> values;
    for (std::int64_t k = 0; k < n; ++k) values.push_back(static_cast<double>((k * 7919) % 4001));
    LeastOfMany least(values);
    EXPECT_EQ(least.value(), *std::min_element(values.begin(), values.end()));
    for (int round = 0; round < 40; ++round) {
      // The least one rises, and one at the end and one in the middle change.
      const std::int64_t at = std::min_element(values.begin(), values.end()) - values.begin();
      const std::vector<std::int64_t> places{at, (round * 631) % n, n - 1};
      for (const std::int64_t k : places) values[k] += static_cast<double>((round * 37) % 101) - 30;
      least.change(values, places);
      EXPECT_EQ(least.value(), *std::min_element(values.begin(), values.end()));
    }
  }
}

TEST(LeastOfMany, of_nothing_is_greater_than_any_value) {
  EXPECT_EQ(LeastOfMany().value(), std::numeric_limits<double>::max());
  EXPECT_EQ(LeastOfMany(std::vector<double>{}).value(), std::numeric_limits<double>::max());
}
