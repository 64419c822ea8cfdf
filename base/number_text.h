// Numbers as messages, names of files and pages show them.
#pragma once

#include <cstdint>
#include <string>

namespace trocar {

// So many digits, "0.0123", "1.2e-05".
std::string short_text(double value, int digits = 3);
// "0.50"
std::string with_decimals(double value, int decimals);
// "000042"
std::string with_zeros(std::int64_t number, int digits);
// The shortest decimal that reads back to the same bits.
std::string shortest_text(double value);
// As TOML has it; reads back to the same bits. "" if it is not finite.
std::string number_text(double value);

}  // namespace trocar
