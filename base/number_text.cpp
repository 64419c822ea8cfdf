#include "base/number_text.h"

#include <cstdio>

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

}  // namespace trocar
