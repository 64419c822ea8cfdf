// The user's text in messages; the distance is that of Damerau and Levenshtein, restricted to one
// edit a substring.
#include "base/quoted.h"

#include <algorithm>
#include <array>
#include <vector>

namespace trocar {

std::string in_quotes(std::string_view text) {
  std::size_t n_shown = std::min<std::size_t>(text.size(), 60);
  while (n_shown > 0 && n_shown < text.size() && !begins_character(text[n_shown])) --n_shown;
  std::string result(1, '"');
  for (const char c : text.substr(0, n_shown)) {
    const auto code = static_cast<unsigned char>(c);
    result.push_back(code < 0x20 || code == 0x7f ? '?' : c);
  }
  if (n_shown < text.size()) result.append("…");
  result.push_back('"');
  return result;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows i-2, i-1 and i of the table of distances between the beginnings of a and b.
  std::array<std::vector<std::size_t>, 3> rows;
  for (std::vector<std::size_t>& row : rows) row.resize(b.size() + 1);
  auto& [two_above, above, row] = rows;
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, above[j] + 1, row[j - 1] + 1});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

// The beginning of a name counts as one change.
static std::size_t distance_to(std::string_view name, const std::string& allowed) {
  return name.size() >= 3 && allowed.starts_with(name) ? 1 : edit_distance(name, allowed);
}

std::string csv_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
  return quoted + "\"";
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return small;
}

std::string in_capital_letters(std::string_view text) {
  std::string capital(text);
  for (char& c : capital) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return capital;
}

std::size_t n_characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string_view first_characters(std::string_view text, std::size_t n) {
  std::size_t end = 0;
  for (; n > 0 && end < text.size(); --n) {
    ++end;
    while (end < text.size() && !begins_character(text[end])) ++end;
  }
  return text.substr(0, end);
}

std::string nearest_name(std::string_view name, std::span<const std::string> allowed) {
  if (allowed.empty() || name.size() > 64) return "";
  const std::string small = in_small_letters(name);
  const auto distance = [&](const std::string& to) {
    return distance_to(small, in_small_letters(to));
  };
  const std::string& nearest = *std::ranges::min_element(allowed, {}, distance);
  const std::size_t most = (std::max(name.size(), nearest.size()) + 2) / 3;
  return distance(nearest) <= most ? nearest : "";
}

std::string names_hint(std::string_view name, std::span<const std::string> names) {
  if (names.empty()) return "; there are none";
  const std::string nearest = nearest_name(name, names);
  std::string text = nearest.empty() ? "" : "; the nearest is " + in_quotes(nearest);
  constexpr std::size_t most_shown = 20;
  for (const std::string& other : names.first(std::min(names.size(), most_shown)))
    text.append(&other == names.data() ? "; there are " : ", ").append(in_quotes(other));
  if (names.size() > most_shown)
    text.append(" and ").append(std::to_string(names.size() - most_shown)).append(" more");
  return text;
}

}  // namespace trocar
