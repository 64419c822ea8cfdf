// Numbers appended to a text: shortest form that reads back to the same bits, in any locale.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace trocar {

template <class Number>
void append_number(std::string& text, Number number) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  text.append(digits.data(), end);
}

}  // namespace trocar
