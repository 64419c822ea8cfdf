// Readers of single values: each says what it needs, what it found and what is allowed.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "base/options_node.h"
#include "base/quoted.h"

namespace trocar {

namespace {

// A number as a sentence shows it.
std::string shown(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = number_text(value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::string shown(double value, const Dimension& dimension) {
  const std::string unit = si_unit(dimension);
  return unit.empty() ? shown(value) : shown(value) + " " + unit;
}

bool is_inside(double value, const Range& range) {
  const bool is_low = range.is_low_open ? value <= range.low : value < range.low;
  const bool is_high = range.is_high_open ? value >= range.high : value > range.high;
  return !is_low && !is_high;
}

// Products of a few of them are numbers still; a scene that needs others has a wrong unit.
constexpr double least_magnitude = 1e-24, greatest_magnitude = 1e24;

bool is_usable(double value) {
  const double magnitude = std::abs(value);
  return value == 0 || (magnitude >= least_magnitude && magnitude <= greatest_magnitude);
}

[[noreturn]] void refuse_kind(const OptionNode& node, const std::string& needed) {
  refuse(node, "needs " + needed + ", found " + description(node));
}

std::string number_needed(const Dimension& dimension) {
  const std::string unit = si_unit(dimension);
  if (unit.empty()) return "a number";
  return "a number in " + unit + " or a text with a unit";
}

double checked(const OptionNode& node, double value, const Dimension& dimension,
               const Range& range) {
  if (!std::isfinite(value)) refuse(node, shown(value) + " is not a finite number");
  const auto refuse_with = [&](const std::string& allowed) {
    refuse(node, shown(value, dimension) + " is out of range; allowed: " + allowed);
  };
  if (!is_inside(value, range)) refuse_with(range_text(range, dimension));
  if (!is_usable(value))
    refuse_with("0 and magnitudes from " + shown(least_magnitude) + " to " +
                shown(greatest_magnitude));
  return value;
}

double parsed(const OptionNode& node, std::string_view text, const Dimension& dimension) {
  try {
    return parse_quantity(text, dimension);
  } catch (const std::invalid_argument& error) {
    refuse(node, error.what());
  }
}

// "0 2 3 mm" or "[0, 2, 3] mm" in pieces: the numbers, then the unit.
std::vector<std::string> split_vector(std::string_view text, std::size_t n) {
  std::vector<std::string> pieces;
  constexpr std::string_view between = " ,[(";
  for (std::size_t i = 0; i < n; ++i) {
    text.remove_prefix(std::min(text.find_first_not_of(between), text.size()));
    const std::size_t end = std::min(text.find_first_of(" ,])"), text.size());
    pieces.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  text.remove_prefix(std::min(text.find_first_not_of(" ])"), text.size()));
  pieces.emplace_back(text);
  return pieces;
}

// "0 2 3mm": what is glued to the last number is the unit of all.
void share_last_unit(const OptionNode& node, std::vector<std::string>& pieces) {
  const auto unit_of = [](const std::string& number) {
    const std::size_t end = number.find_first_not_of("0123456789+-.eE");
    return end == std::string::npos ? std::string() : number.substr(end);
  };
  std::string& common = pieces.back();
  const std::size_t n = pieces.size() - 1;
  const auto needs_unit = [&](const std::string& piece) {
    return unit_of(piece).empty() && piece.find_first_of("123456789") != std::string::npos;
  };
  const std::span<const std::string> numbers(pieces.data(), n);
  const auto n_with_unit = std::ranges::count_if(
      numbers, [&](const std::string& piece) { return !unit_of(piece).empty(); });
  if (!common.empty() || n_with_unit == 0 || std::ranges::none_of(numbers, needs_unit)) return;
  const std::string unit = unit_of(pieces[n - 1]);
  if (n_with_unit > 1 || unit.empty())
    refuse(node, in_quotes(node.text) +
                     " has units for some of its numbers only: one after the "
                     "last, or one for each");
  pieces[n - 1].resize(pieces[n - 1].size() - unit.size());
  common = unit;
}

std::vector<double> read_vector_text(const OptionNode& node, const Dimension& dimension,
                                     std::size_t n, const Range& range) {
  std::vector<std::string> pieces = split_vector(node.text, n);
  for (std::size_t i = 0; i < n; ++i)
    if (pieces[i].find_first_of("0123456789+-.") != 0)
      refuse_kind(node, dimension == dim::none ? "a list of " + std::to_string(n) + " numbers"
                                               : std::to_string(n) + " numbers and a unit");
  share_last_unit(node, pieces);
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    const double value = parsed(node, pieces[i] + " " + pieces[n], dimension);
    values.push_back(checked(node, value, dimension, range));
  }
  return values;
}

void check_length(const OptionNode& node, std::size_t n, const std::string& what) {
  if (node.kind != NodeKind::list || node.below.size() != n)
    refuse_kind(node, "a list of " + std::to_string(n) + " " + what);
}

// Reads every component, so that each bad one is reported; the last error goes on to the caller.
template <class Read>
auto read_each(const OptionNode& list, const Read& read) {
  std::vector<decltype(read(list))> values;
  std::optional<OptionRefusal> last;
  for (const OptionNode& one : list.below) {
    try {
      values.push_back(read(one));
    } catch (const OptionRefusal& refusal) {
      if (last) list.document->errors->add(last->error());
      last = refusal;
    }
  }
  if (last) throw OptionRefusal(*last);
  return values;
}

}  // namespace

double read_number(const OptionNode& node, const Dimension& dimension, const Range& range) {
  if (node.kind == NodeKind::text)
    return checked(node, parsed(node, node.text, dimension), dimension, range);
  if (node.kind != NodeKind::number && node.kind != NodeKind::integer)
    refuse_kind(node, number_needed(dimension));
  return checked(node, node.number, dimension, range);
}

int read_integer(const OptionNode& node, const Range& range) {
  if (node.kind != NodeKind::integer) refuse_kind(node, "an integer");
  constexpr std::int64_t least = std::numeric_limits<int>::min();
  constexpr std::int64_t greatest = std::numeric_limits<int>::max();
  const std::string found = std::to_string(node.integer);
  if (!is_inside(node.number, range))
    refuse(node, found + " is out of range; allowed: " + range_text(range, dim::none));
  if (node.integer < least || node.integer > greatest)
    refuse(node, found + " is out of range; allowed: " + std::to_string(least) + " to " +
                     std::to_string(greatest));
  return static_cast<int>(node.integer);
}

bool read_boolean(const OptionNode& node) {
  if (node.kind != NodeKind::boolean) refuse_kind(node, "true or false");
  return node.integer != 0;
}

std::string read_text(const OptionNode& node) {
  if (node.kind != NodeKind::text) refuse_kind(node, "a text in quotes");
  // A file name would silently end there.
  if (node.text.find('\0') != std::string::npos) refuse(node, "a text can't hold a NUL character");
  return node.text;
}

std::vector<double> read_numbers(const OptionNode& node, const Dimension& dimension, std::size_t n,
                                 const Range& range) {
  if (node.kind == NodeKind::text) return read_vector_text(node, dimension, n, range);
  check_length(node, n, "numbers");
  return read_each(node, [&](const OptionNode& one) { return read_number(one, dimension, range); });
}

std::vector<int> read_integers(const OptionNode& node, std::size_t n, const Range& range) {
  check_length(node, n, "integers");
  return read_each(node, [&](const OptionNode& one) { return read_integer(one, range); });
}

std::size_t read_choice(const OptionNode& node, const std::vector<std::string>& names) {
  if (node.kind != NodeKind::text) refuse_kind(node, "one of " + choices_text(names));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == node.text) return i;
  const std::string nearest = nearest_name(node.text, names);
  const std::string hint = nearest.empty() ? "" : "; the nearest is " + in_quotes(nearest);
  refuse(node, in_quotes(node.text) + " is not one of the choices" + hint +
                   "; allowed: " + choices_text(names));
}

std::string description(const OptionNode& node) {
  switch (node.kind) {
    case NodeKind::table:
      return "a table";
    case NodeKind::list:
      return "a list of " + std::to_string(node.below.size()) +
             (node.below.size() == 1 ? " value" : " values");
    case NodeKind::text:
      return "the text " + in_quotes(node.text);
    case NodeKind::number:
      return "the number " + shown(node.number);
    case NodeKind::integer:
      return "the integer " + std::to_string(node.integer);
    case NodeKind::boolean:
      return node.integer != 0 ? "true" : "false";
    case NodeKind::date:
      return "a date or time";
  }
  return "";
}

}  // namespace trocar
