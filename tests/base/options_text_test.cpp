#include <gtest/gtest.h>

#include <cmath>

#include "base/options.h"

namespace trocar {
namespace {

TEST(NumberText, is_the_shortest_toml_float) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(3), "3.0");
  EXPECT_EQ(number_text(-0.0), "-0.0");
  EXPECT_EQ(number_text(1e300), "1e+300");
}

TEST(NumberText, is_empty_for_what_is_not_finite) {
  EXPECT_EQ(number_text(std::nan("")), "");
  EXPECT_EQ(number_text(INFINITY), "");
  const double values[] = {1, INFINITY};
  EXPECT_EQ(numbers_text(values), "");
}

TEST(QuotedText, escapes_what_toml_does_not_allow_in_a_string) {
  EXPECT_EQ(quoted_text("a\"b\\c\nd\x1f\x7f"), "\"a\\\"b\\\\c\\u000ad\\u001f\\u007f\"");
}

TEST(RangeText, names_both_ends_and_the_unit) {
  EXPECT_EQ(range_text(any, dim::length), "");
  EXPECT_EQ(range_text(positive, dim::pressure), "> 0 Pa");
  EXPECT_EQ(range_text(not_negative, dim::none), ">= 0");
  EXPECT_EQ(range_text({.low = -1, .high = 0.5, .is_high_open = true}, dim::none),
            ">= -1 and < 0.5");
  EXPECT_EQ(range_text({.high = 2}, dim::length), "<= 2 m");
}

}  // namespace
}  // namespace trocar
