#include "base/units.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace trocar {
namespace {

std::string message(const std::string& text, const Dimension& dimension) {
  try {
    parse_quantity(text, dimension);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

void expect_in_message(const std::string& text, const Dimension& dimension,
                       const std::string& part) {
  const std::string found = message(text, dimension);
  EXPECT_NE(found.find(part), std::string::npos) << found;
}

TEST(Quantity, of_every_dimension_is_read_in_si) {
  EXPECT_EQ(parse_quantity("2 mm", dim::length), 0.002);
  EXPECT_EQ(parse_quantity("2 cm", dim::length), 0.02);
  EXPECT_EQ(parse_quantity("5 um", dim::length), 5e-6);
  EXPECT_EQ(parse_quantity("5 µm", dim::length), 5e-6);
  EXPECT_EQ(parse_quantity("3 kPa", dim::pressure), 3000);
  EXPECT_EQ(parse_quantity("1.5 N/mm^2", dim::pressure), 1.5e6);
  EXPECT_EQ(parse_quantity("1060 kg/m^3", dim::density), 1060);
  EXPECT_EQ(parse_quantity("1.06 g/cm^3", dim::density), 1060);
  EXPECT_EQ(parse_quantity("1.06 g/ml", dim::density), 1060);
  EXPECT_EQ(parse_quantity("1 kg/l", dim::density), 1000);
  EXPECT_EQ(parse_quantity("1 cmH2O", dim::pressure), 98.0665);  // the conventional one
  EXPECT_EQ(parse_quantity("10 1/s", dim::rate), 10);
  EXPECT_EQ(parse_quantity("10 /s", dim::rate), 10);
  EXPECT_EQ(parse_quantity("30 Hz", dim::rate), 30);
  EXPECT_EQ(parse_quantity("10 ms", dim::time), 0.01);
  EXPECT_EQ(parse_quantity("2 min", dim::time), 120);
  EXPECT_EQ(parse_quantity("2 mN", dim::force), 0.002);
  EXPECT_EQ(parse_quantity("2 kg*m/s^2", dim::force), 2);
  EXPECT_EQ(parse_quantity("5 g", dim::mass), 0.005);
  EXPECT_EQ(parse_quantity("36 km/h", dim::velocity), 10);
  EXPECT_EQ(parse_quantity("9.81 m/s^2", dim::acceleration), 9.81);
  EXPECT_EQ(parse_quantity("9.81 m*s^-2", dim::acceleration), 9.81);
  EXPECT_EQ(parse_quantity("45 %", dim::none), 0.45);
}

TEST(Quantity, in_degrees_is_an_angle_in_radians) {
  // One multiplication and one division: 1 unit in the last place each.
  EXPECT_DOUBLE_EQ(parse_quantity("180 deg", dim::angle), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_quantity("30 deg", dim::angle), std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(parse_quantity("90°", dim::angle), std::numbers::pi / 2);
  EXPECT_EQ(parse_quantity("1.5 rad", dim::angle), 1.5);
}

TEST(Quantity, without_a_unit_is_si) {
  EXPECT_EQ(parse_quantity("3", dim::pressure), 3);
  EXPECT_EQ(parse_quantity(" -2.5e-3 ", dim::length), -2.5e-3);
}

TEST(Quantity, takes_every_way_to_write_a_number) {
  for (const char* text : {"2 mm", "2mm", "+2 mm", "2. mm", "2.0 mm", "0.2e1mm", "20E-1 mm"})
    EXPECT_EQ(parse_quantity(text, dim::length), 0.002) << text;
  EXPECT_EQ(parse_quantity(".5 mm", dim::length), 0.0005);
}

TEST(Quantity, with_a_decimal_prefix_has_the_bits_of_the_number_with_that_exponent) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1000, 1000);
  for (int i = 0; i < 1000; ++i) {
    char digits[40];
    *std::to_chars(digits, digits + sizeof digits, uniform(random), std::chars_format::fixed).ptr =
        0;
    // strtod rounds correctly, so it is what the decimal number means.
    const double expected = std::strtod((std::string(digits) + "e-3").c_str(), nullptr);
    EXPECT_EQ(parse_quantity(std::string(digits) + " mm", dim::length), expected);
  }
}

TEST(Quantity, of_a_wrong_dimension_says_what_it_is_and_which_units_fit) {
  EXPECT_EQ(message("3 s", dim::length),
            "\"3 s\" is a time, but a length is needed; units that fit: m, cm, mm, um");
  expect_in_message("3 mm", dim::angle, "is a length, but an angle is needed");
  expect_in_message("3 rad", dim::none, "is an angle, but a plain number is needed");
  expect_in_message("2 1/deg", dim::angle, "is a quantity in 1/rad, but an angle is needed");
  expect_in_message("3 rad^2", dim::angle, "is a quantity in rad^2, but an angle is needed");
  expect_in_message("3 kPa", {.metre = 2, .second = -1},
                    "is a pressure, but a quantity in m^2/s is needed");
}

TEST(Quantity, that_is_none_says_why) {
  expect_in_message("", dim::length, "does not begin with a number; a length is needed");
  expect_in_message("two mm", dim::length, "does not begin with a number");
  expect_in_message("nan m", dim::length, "does not begin with a number");
  expect_in_message("inf", dim::length, "does not begin with a number");
  expect_in_message(". mm", dim::length, "does not begin with a number");
  expect_in_message("3 kPas", dim::pressure, "unknown unit \"kPas\"; units that fit: Pa, kPa");
  expect_in_message("3 m//s", dim::velocity, "unknown unit \"\"");
  expect_in_message("3 m^", dim::length, "no whole number behind ^");
  expect_in_message("3 m^12", dim::length, "exponent above 9");
  expect_in_message("3 m^2x", dim::length, "can't be read");
  expect_in_message("1e999 m", dim::length, "is too large");
  expect_in_message("1e308 km", dim::length, "is too large");
  expect_in_message(std::string(400, '1') + "e-1 m", dim::length, "is too large");
  expect_in_message("0." + std::string(400, '0') + "1e1 m", dim::length, "is too close to zero");
  expect_in_message("1e-999999999999 m", dim::length, "is too close to zero");
  expect_in_message("1 m*m*m*m*m*m*m*m*m", dim::length, "more than 8 factors");
}

TEST(SiUnit, reads_back_as_one_of_its_dimension) {
  EXPECT_EQ(si_unit(dim::none), "");
  EXPECT_EQ(si_unit(dim::pressure), "Pa");
  EXPECT_EQ(si_unit(dim::density), "kg/m^3");
  EXPECT_EQ(si_unit(dim::acceleration), "m/s^2");
  EXPECT_EQ(si_unit(dim::rate), "1/s");
  EXPECT_EQ(si_unit(dim::angle), "rad");
  for (int metre = -3; metre <= 3; ++metre)
    for (int kilogram = -1; kilogram <= 1; ++kilogram)
      for (int second = -3; second <= 3; ++second) {
        const Dimension dimension{.metre = metre, .kilogram = kilogram, .second = second};
        EXPECT_EQ(parse_quantity("7 " + si_unit(dimension), dimension), 7) << si_unit(dimension);
      }
}

}  // namespace
}  // namespace trocar
