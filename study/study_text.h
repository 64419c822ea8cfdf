// Numbers as people read them.
#pragma once

#include <string>

namespace trocar {

// Rounded to this many digits, without an exponent between 1e-4 and 1e6.
std::string significant(double value, int digits);
// "1.25 mm", "3.4 um".
std::string length_text(double metres);
std::string percent_text(double share);  // "0.31 %"
// "0.8 ms", "12 s"
std::string seconds_text(double seconds);

}  // namespace trocar
