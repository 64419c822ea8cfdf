#include "study/study_text.h"

#include <cmath>

#include "base/number_text.h"

namespace trocar {

std::string significant(double value, int digits) {
  const double size = std::abs(value);
  // short_text changes to an exponent as soon as the number has more places than digits.
  if (size >= 1 && size < 1e6) {
    const double step = std::pow(10., std::floor(std::log10(size)) + 1 - digits);
    if (step >= 1) return with_decimals(std::round(value / step) * step, 0);
  }
  return short_text(value, digits);
}

namespace {

std::string scaled(double value, double unit, const char* name) {
  return significant(value / unit, 3) + " " + name;
}

}  // namespace

std::string length_text(double metres) {
  const double size = std::abs(metres);
  if (size >= 1) return scaled(metres, 1, "m");
  return size >= 1e-4 ? scaled(metres, 1e-3, "mm") : scaled(metres, 1e-6, "um");
}

std::string percent_text(double share) {
  return significant(100 * share, 2) + " %";
}

std::string seconds_text(double seconds) {
  const double size = std::abs(seconds);
  if (size >= 1) return scaled(seconds, 1, "s");
  return size >= 1e-4 ? scaled(seconds, 1e-3, "ms") : scaled(seconds, 1e-6, "us");
}

}  // namespace trocar
