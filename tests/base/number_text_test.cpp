#include "base/number_text.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(NumberText, has_so_many_digits_and_an_exponent_for_what_is_small) {
  EXPECT_EQ(short_text(0.012345), "0.0123");
  EXPECT_EQ(short_text(1.2e-5), "1.2e-05");
  EXPECT_EQ(short_text(0.012346, 4), "0.01235");
}

TEST(NumberText, keeps_its_decimals_and_all_places_before_the_point) {
  EXPECT_EQ(with_decimals(0.5, 2), "0.50");
  EXPECT_EQ(with_decimals(-1e300, 0).size(), 302u);  // a sign, a one and 300 zeros
}

TEST(NumberText, is_filled_up_with_zeros_and_never_cut_off) {
  EXPECT_EQ(with_zeros(42, 6), "000042");
  EXPECT_EQ(with_zeros(1234567, 6), "1234567");
}

}  // namespace
}  // namespace trocar
