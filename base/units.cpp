// Quantities with units. The decimal power of the unit goes into the number's exponent before the
// number is read, so that "2 mm" is the double nearest to 0.002, the same bits as 2e-3.
#include "base/units.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "base/quoted.h"

namespace trocar {

namespace {

// One unit in SI: factor / divisor * 10^power.
struct Unit {
  std::string_view symbol;
  Dimension dimension;
  int power = 0;
  double factor = 1;
  double divisor = 1;
  bool takes_prefix = false;
};

constexpr Unit units[] = {
    {"m", dim::length, 0, 1, 1, true},
    {"g", dim::mass, -3, 1, 1, true},
    {"t", dim::mass, 3},
    {"s", dim::time, 0, 1, 1, true},
    {"min", dim::time, 0, 60},
    {"h", dim::time, 0, 3600},
    {"Hz", dim::rate, 0, 1, 1, true},
    {"N", dim::force, 0, 1, 1, true},
    {"Pa", dim::pressure, 0, 1, 1, true},
    {"bar", dim::pressure, 5, 1, 1, true},
    {"mmHg", dim::pressure, 0, 133.322387415},
    {"cmH2O", dim::pressure, 0, 98.0665},
    {"l", {.metre = 3}, -3, 1, 1, true},
    {"J", {.metre = 2, .kilogram = 1, .second = -2}, 0, 1, 1, true},
    {"W", {.metre = 2, .kilogram = 1, .second = -3}, 0, 1, 1, true},
    {"rad", dim::angle, 0, 1, 1, true},
    {"deg", dim::angle, 0, std::numbers::pi, 180},
    {"°", dim::angle, 0, std::numbers::pi, 180},
    {"%", dim::none, -2},
    {"1", dim::none},
};

struct Prefix {
  std::string_view symbol;
  int power;
};
constexpr Prefix prefixes[] = {{"n", -9}, {"u", -6}, {"µ", -6}, {"μ", -6}, {"m", -3},
                               {"c", -2}, {"d", -1}, {"k", 3},  {"M", 6},  {"G", 9}};

struct Kind {
  Dimension dimension;
  std::string_view name;
  std::string_view fitting_units;
};
constexpr Kind kinds[] = {
    {dim::none, "a plain number", "none, or %"},
    {dim::length, "a length", "m, cm, mm, um"},
    {dim::time, "a time", "s, ms, us, min, h"},
    {dim::rate, "a rate", "1/s, Hz, kHz"},
    {dim::mass, "a mass", "kg, g, mg, t"},
    {dim::density, "a density", "kg/m^3, g/cm^3, g/ml"},
    {dim::pressure, "a pressure", "Pa, kPa, MPa, GPa, N/m^2, bar, mmHg, cmH2O"},
    {dim::force, "a force", "N, mN, kN"},
    {dim::velocity, "a velocity", "m/s, cm/s, mm/s"},
    {dim::acceleration, "an acceleration", "m/s^2, mm/s^2"},
    {dim::angle, "an angle", "rad, mrad, deg"},
};

const Kind* find_kind(const Dimension& dimension) {
  for (const Kind& kind : kinds)
    if (kind.dimension == dimension) return &kind;
  return nullptr;
}

std::string kind_name(const Dimension& dimension) {
  const Kind* kind = find_kind(dimension);
  if (kind != nullptr) return std::string(kind->name);
  return std::string("a quantity in ").append(si_unit(dimension));
}

std::string fitting_units(const Dimension& dimension) {
  const Kind* kind = find_kind(dimension);
  const std::string units_text =
      kind != nullptr ? std::string(kind->fitting_units) : si_unit(dimension);
  return std::string("; units that fit: ").append(units_text);
}

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw std::invalid_argument(in_quotes(text).append(" ").append(why));
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<Unit> find_plain_unit(std::string_view symbol) {
  for (const Unit& unit : units)
    if (unit.symbol == symbol) return unit;
  return std::nullopt;
}

std::optional<Unit> find_unit(std::string_view symbol) {
  std::optional<Unit> unit = find_plain_unit(symbol);
  if (unit) return unit;
  for (const Prefix& prefix : prefixes) {
    if (!symbol.starts_with(prefix.symbol)) continue;
    unit = find_plain_unit(symbol.substr(prefix.symbol.size()));
    if (!unit || !unit->takes_prefix) continue;
    unit->power += prefix.power;
    return unit;
  }
  return std::nullopt;
}

// product *= unit^exponent
void multiply(Unit& product, const Unit& unit, int exponent) {
  product.dimension.metre += exponent * unit.dimension.metre;
  product.dimension.kilogram += exponent * unit.dimension.kilogram;
  product.dimension.second += exponent * unit.dimension.second;
  product.dimension.radian += exponent * unit.dimension.radian;
  product.power += exponent * unit.power;
  for (int i = 0; i < std::abs(exponent); ++i) {
    product.factor *= exponent > 0 ? unit.factor : unit.divisor;
    product.divisor *= exponent > 0 ? unit.divisor : unit.factor;
  }
}

// The integer behind '^'; takes it off `text`.
int take_exponent(std::string_view& text, std::string_view whole) {
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  if (text.empty() || !is_digit(text[0])) refuse(whole, "has no whole number behind ^");
  const int exponent = text[0] - '0';
  text.remove_prefix(1);
  if (!text.empty() && is_digit(text[0])) refuse(whole, "has an exponent above 9");
  return is_negative ? -exponent : exponent;
}

// "kg/m^3" as one unit: symbols with optional exponents, joined by * and /, read from left to
// right.
Unit parse_unit(std::string_view text, std::string_view whole, const Dimension& wanted) {
  Unit product{"", dim::none};
  int sign = text.starts_with('/') ? -1 : 1;  // "10 /s" is "10 1/s"
  if (sign < 0) text.remove_prefix(1);
  for (int n_factors = 0;; ++n_factors) {
    if (n_factors == 8) refuse(whole, "has a unit of more than 8 factors");
    const std::string_view symbol = trimmed(text.substr(0, text.find_first_of("*/^")));
    const std::optional<Unit> unit = find_unit(symbol);
    if (!unit) refuse(whole, "has the unknown unit " + in_quotes(symbol) + fitting_units(wanted));
    text.remove_prefix(std::min(text.size(), text.find_first_of("*/^")));
    int exponent = 1;
    if (text.starts_with('^')) {
      text.remove_prefix(1);
      exponent = take_exponent(text, whole);
      text = trimmed(text);
    }
    multiply(product, *unit, sign * exponent);
    if (text.empty()) return product;
    if (text[0] != '*' && text[0] != '/') refuse(whole, "has a unit that can't be read");
    sign = text[0] == '/' ? -1 : 1;
    text.remove_prefix(1);
  }
}

// A decimal number: digits with at most one point, and an exponent.
struct Decimal {
  std::string digits;
  int exponent = 0;
  std::size_t length = 0;  // in the text; 0: there is no number
};

std::size_t count_digits(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end - begin;
}

// The exponent at text[begin] ("e-3"), or nothing: in "3 e" and "2em" the e belongs to the unit.
void read_exponent(std::string_view text, std::size_t begin, Decimal& number) {
  std::size_t i = begin;
  if (i == text.size() || (text[i] != 'e' && text[i] != 'E')) return;
  ++i;
  const bool is_negative = i < text.size() && text[i] == '-';
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  const std::size_t n_digits = count_digits(text, i);
  if (n_digits == 0) return;
  // Beyond the range of int the number is beyond that of double too; 99999 is beyond both.
  if (std::from_chars(text.data() + i, text.data() + i + n_digits, number.exponent).ec !=
      std::errc())
    number.exponent = 99999;
  number.exponent = std::min(number.exponent, 99999) * (is_negative ? -1 : 1);
  number.length = i + n_digits;
}

Decimal read_decimal(std::string_view text) {
  Decimal number;
  const std::size_t begin = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const std::size_t n_whole = count_digits(text, begin);
  std::size_t end = begin + n_whole;
  std::size_t n_behind = 0;
  if (end < text.size() && text[end] == '.') {
    n_behind = count_digits(text, end + 1);
    end += 1 + n_behind;
  }
  if (n_whole + n_behind == 0) return number;
  number.digits = text.substr(text[0] == '+' ? 1 : 0, end - (text[0] == '+' ? 1 : 0));
  number.length = end;
  read_exponent(text, end, number);
  return number;
}

// Whether a number that double can't hold is too large, rather than too close to zero.
bool is_above_one(const Decimal& number, int power) {
  const std::string& digits = number.digits;
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  const auto first = static_cast<std::int64_t>(digits.find_first_of("123456789"));
  return point - first + number.exponent + power > 0;
}

double scaled(const Decimal& number, int power, std::string_view whole) {
  std::string text = number.digits;
  text.append("e").append(std::to_string(number.exponent + power));
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range)
    refuse(whole, is_above_one(number, power) ? "is too large" : "is too close to zero");
  return value;
}

}  // namespace

double parse_quantity(std::string_view text, const Dimension& dimension) {
  const std::string_view whole = trimmed(text);
  const Decimal number = read_decimal(whole);
  if (number.length == 0)
    refuse(whole, "does not begin with a number; " + kind_name(dimension) + " is needed" +
                      fitting_units(dimension));
  const std::string_view unit_text = trimmed(whole.substr(number.length));
  if (unit_text.empty()) return scaled(number, 0, whole);
  const Unit unit = parse_unit(unit_text, whole, dimension);
  if (unit.dimension != dimension)
    refuse(whole, "is " + kind_name(unit.dimension) + ", but " + kind_name(dimension) +
                      " is needed" + fitting_units(dimension));
  const double value = scaled(number, unit.power, whole) * unit.factor / unit.divisor;
  if (!std::isfinite(value)) refuse(whole, "is too large");
  return value;
}

static void append_power(std::string& text, const char* symbol, int exponent) {
  if (!text.empty()) text.append("*");
  text.append(symbol);
  if (exponent > 1) text.append("^").append(std::to_string(exponent));
}

std::string si_unit(const Dimension& dimension) {
  if (dimension == dim::pressure) return "Pa";
  if (dimension == dim::force) return "N";
  std::string above, below;
  const std::pair<const char*, int> powers[] = {{"rad", dimension.radian},
                                                {"kg", dimension.kilogram},
                                                {"m", dimension.metre},
                                                {"s", dimension.second}};
  for (const auto& [symbol, exponent] : powers) {
    if (exponent > 0) append_power(above, symbol, exponent);
    if (exponent >= 0) continue;
    std::string factor;
    append_power(factor, symbol, -exponent);
    below.append("/").append(factor);
  }
  if (above.empty() && !below.empty()) above.push_back('1');
  return above + below;
}

}  // namespace trocar
