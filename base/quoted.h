// How a piece of the user's text appears in a message, and which allowed name may have been meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace trocar {

// In double quotes, at most 60 bytes (cut with … between characters), control characters as "?".
std::string in_quotes(std::string_view text);

// A cell of a CSV file as RFC 4180 quotes it.
std::string csv_quoted(std::string_view text);

// Letters of ASCII only.
std::string in_small_letters(std::string_view text);
std::string in_capital_letters(std::string_view text);

// A byte 10xxxxxx continues a character of UTF-8.
constexpr bool begins_character(char byte) {
  return (byte & 0xc0) != 0x80;
}
std::size_t n_characters(std::string_view text);
// The first n characters, or all.
std::string_view first_characters(std::string_view text, std::size_t n);

// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
// (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);
// The allowed name nearest to `name`, the first of equals; "" if more than a third of the letters
// differ, or `name` is longer than any sane one. What `name` begins counts as near.
std::string nearest_name(std::string_view name, std::span<const std::string> allowed);

// What there is instead of a name that there is not: "; the nearest is "top"; there are "top",
// "bottom"", at most 20 of them, or "; there are none".
std::string names_hint(std::string_view name, std::span<const std::string> names);

}  // namespace trocar
