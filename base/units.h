// Quantities with units: "3 kPa", "2 mm", "30 deg", "1060 kg/m^3", "10 1/s". A bare number is SI.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace trocar {

// Exponents. Radians are plain numbers that know that they are angles.
struct Dimension {
  int metre = 0;
  int kilogram = 0;
  int second = 0;
  int radian = 0;
  bool operator==(const Dimension&) const = default;
};

namespace dim {
inline constexpr Dimension none{};
inline constexpr Dimension length{.metre = 1};
inline constexpr Dimension time{.second = 1};
inline constexpr Dimension rate{.second = -1};
inline constexpr Dimension mass{.kilogram = 1};
inline constexpr Dimension density{.metre = -3, .kilogram = 1};
inline constexpr Dimension pressure{.metre = -1, .kilogram = 1, .second = -2};
inline constexpr Dimension force{.metre = 1, .kilogram = 1, .second = -2};
inline constexpr Dimension velocity{.metre = 1, .second = -1};
inline constexpr Dimension acceleration{.metre = 1, .second = -2};
inline constexpr Dimension angle{.radian = 1};
}  // namespace dim

// Value in SI. Throws std::invalid_argument with a sentence that says what is wrong and which units
// fit.
double parse_quantity(std::string_view text, const Dimension& dimension);
// "Pa", "m", "kg/m^3", "rad", "" : how the SI unit of a dimension is written.
std::string si_unit(const Dimension& dimension);

}  // namespace trocar
