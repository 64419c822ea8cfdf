// Values and what is allowed as text: TOML for the echo, sentences for messages and help.
#include <algorithm>
#include <cmath>

#include "base/options.h"
#include "base/quoted.h"

namespace trocar {

template <class Value, class Text>
static std::string list_text(std::span<const Value> values, const Text& text_of) {
  std::string list(1, '[');
  for (const Value value : values) {
    const std::string text = text_of(value);
    if (text.empty()) return "";
    if (list.size() > 1) list.append(", ");
    list.append(text);
  }
  list.push_back(']');
  return list;
}

std::string item_path(const std::string& list, std::size_t number) {
  return list + "[" + std::to_string(number) + "]";
}

std::string numbers_text(std::span<const double> values) {
  if (std::ranges::any_of(values, [](double x) { return std::isnan(x); })) return "";
  return list_text(values, number_text);
}

std::string integers_text(std::span<const int> values) {
  return list_text(values, [](int value) { return std::to_string(value); });
}

std::string quoted_text(const std::string& value) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text(1, '"');
  for (const char c : value) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text.push_back('\\');
      text.push_back(c);
    } else if (code < 0x20 || code == 0x7f) {
      text.append("\\u00").append(1, digits[code >> 4]).append(1, digits[code & 15]);
    } else {
      text.push_back(c);
    }
  }
  text.push_back('"');
  return text;
}

std::string number_type_text(const Dimension& dimension) {
  const std::string unit = si_unit(dimension);
  return unit.empty() ? "number" : "number [" + unit + "]";
}

std::string range_text(const Range& range, const Dimension& dimension) {
  std::string text;
  if (std::isfinite(range.low))
    text.append(range.is_low_open ? "> " : ">= ").append(shortest_text(range.low));
  if (std::isfinite(range.high)) {
    if (!text.empty()) text.append(" and ");
    text.append(range.is_high_open ? "< " : "<= ").append(shortest_text(range.high));
  }
  const std::string unit = si_unit(dimension);
  if (!text.empty() && !unit.empty()) text.append(" ").append(unit);
  return text;
}

std::string choices_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    if (!text.empty()) text.append(", ");
    text.append(in_quotes(name));
  }
  return text;
}

}  // namespace trocar
