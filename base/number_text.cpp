#include "base/number_text.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/check.h"

namespace trocar {

std::string short_text(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string with_decimals(double value, int decimals) {
  char text[512];  // up to 310 places before the point
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string with_zeros(std::int64_t number, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%0*lld", digits, static_cast<long long>(number));
  return text;
}

std::string shortest_text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  CHECK(result.ec == std::errc());
  return {buffer, result.ptr};
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return "";
  std::string text = shortest_text(value);
  // Without a point or an exponent TOML reads an integer, and -0 would lose its sign.
  if (text.find_first_of(".e") == std::string::npos) text.append(".0");
  return text;
}

}  // namespace trocar
