// A first look at a text that may be hostile: UTF-8, no NUL, bounded nesting and number of values.
// The parser recurses and allocates per value, so these bounds are what keeps its stack and memory
// small.
#include <algorithm>
#include <optional>

#include "base/options_node.h"
#include "base/quoted.h"

namespace trocar {

namespace {

constexpr int max_depth = 64;
constexpr std::size_t max_values = 200'000;

[[noreturn]] void fail_at(std::string_view text, std::size_t offset, const std::string& sentence) {
  const std::string_view before = text.substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  const std::size_t column = 1 + n_characters(before.substr(line_begin));
  throw SyntaxTrouble{static_cast<int>(line), static_cast<int>(column), sentence};
}

// Bytes of the UTF-8 character at the begin of `text`, 0 if there is none (RFC 3629: shortest form,
// no surrogates).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto continues = [&](std::size_t i) {
    return i < text.size() && !begins_character(text[i]);
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return continues(1) ? 2 : 0;
  if (first >= 0xe0 && first < 0xf0) {
    const bool is_too_long = first == 0xe0 && byte(1) < 0xa0;
    const bool is_surrogate = first == 0xed && byte(1) >= 0xa0;
    return continues(1) && continues(2) && !is_too_long && !is_surrogate ? 3 : 0;
  }
  if (first >= 0xf0 && first < 0xf5) {
    const bool is_too_long = first == 0xf0 && byte(1) < 0x90;
    const bool is_too_large = first == 0xf4 && byte(1) >= 0x90;
    const bool is_whole = continues(1) && continues(2) && continues(3);
    return is_whole && !is_too_long && !is_too_large ? 4 : 0;
  }
  return 0;
}

// The end of the string that begins at text[begin] with a quote; a one-line string ends at the
// line's end at the latest.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
  const bool is_multi_line = text.substr(begin, 3) == triple;
  const bool has_escapes = quote == '"';
  for (std::size_t i = begin + (is_multi_line ? 3 : 1); i < text.size(); ++i) {
    if (has_escapes && text[i] == '\\') {
      ++i;
    } else if (is_multi_line) {
      if (text.substr(i, 3) == triple) return i + 3;
    } else if (text[i] == quote) {
      return i + 1;
    } else if (text[i] == '\n') {
      break;
    }
  }
  fail_at(text, begin, "a text without its closing quote");
}

// Counts what makes the parser recurse or allocate.
struct Structure {
  int depth = 0;
  int n_dots = 0;  // in the dotted key that is being read
  std::size_t n_values = 0;

  void take(char c) {
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == '.') ++n_dots;
    const bool is_separator = c == ',' || c == '=' || c == '[' || c == '{';
    if (is_separator) ++n_values;
    if (is_separator || c == '\n' || c == ']' || c == '}') n_dots = 0;
    if (c == '.' && n_dots > 1) ++n_values;
  }
};

void check_structure(std::string_view text) {
  Structure structure;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    structure.take(c);
    if (structure.depth > max_depth || structure.n_dots > max_depth)
      fail_at(text, i, "nested deeper than " + std::to_string(max_depth) + " levels");
    if (structure.n_values > max_values)
      fail_at(text, i, "more than " + std::to_string(max_values) + " values in one file");
    ++i;
  }
}

}  // namespace

void check_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '\0') fail_at(text, i, "a NUL byte; is this a binary file?");
    const std::size_t length = character_length(text.substr(i, 4));
    if (length == 0) fail_at(text, i, "a byte that is not UTF-8; save the file as UTF-8");
    i += length;
  }
}

void scan_toml(std::string_view text) {
  check_characters(text);
  check_structure(text);
}

}  // namespace trocar
