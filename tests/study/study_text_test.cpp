#include "study/study_text.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(StudyText, numbers_are_rounded_to_digits_and_keep_out_of_exponents) {
  EXPECT_EQ(significant(3.14159, 3), "3.14");
  EXPECT_EQ(significant(123456, 3), "123000");
  EXPECT_EQ(significant(0.00123456, 2), "0.0012");
  EXPECT_EQ(significant(999.9, 3), "1000");
  EXPECT_EQ(significant(1.5e7, 3), "1.5e+07");
  EXPECT_EQ(significant(-2345, 2), "-2300");
}

TEST(StudyText, quantities_carry_the_unit_that_fits_their_size) {
  EXPECT_EQ(length_text(0.00125), "1.25 mm");
  EXPECT_EQ(length_text(2.5), "2.5 m");
  EXPECT_EQ(length_text(3.4e-6), "3.4 um");
  EXPECT_EQ(percent_text(0.00312), "0.31 %");
  EXPECT_EQ(seconds_text(0.0021), "2.1 ms");
  EXPECT_EQ(seconds_text(12), "12 s");
}

}  // namespace
}  // namespace trocar
