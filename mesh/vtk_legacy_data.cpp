#include "mesh/vtk_legacy_data.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "base/quoted.h"

namespace trocar {

namespace {

// Values of an array: numbers, single bits or texts.
struct ValueType {
  VtkNumber number;
  bool is_bit = false, is_text = false;
};

ValueType read_value_type(FileReader& in) {
  const std::string_view name = in.peek_word();
  const bool is_bit = name == "bit", is_text = name == "string" || name == "utf8_string";
  if (!is_bit && !is_text) return {.number = read_number_type(in)};
  in.word("a type of values");
  return {.number = {}, .is_bit = is_bit, .is_text = is_text};
}

// A binary text stands behind its length, whose first two bits say in how many bytes.
void skip_binary_text(FileReader& in) {
  const auto first = in.raw<std::uint8_t>("the length of a text");
  std::int64_t length = first & 63;
  for (int k = (1 << (3 - (first >> 6))) - 1; k > 0; --k)
    length = length << 8 | in.raw<std::uint8_t>("the length of a text");
  in.take(in.check_count(length, 1, "bytes of a text"), "a text");
}

void skip_texts(FileReader& in, std::size_t n) {
  if (!in.is_binary) in.line();  // of the header
  for (std::size_t k = 0; k < n; ++k) {
    if (in.is_binary)
      skip_binary_text(in);
    else if (in.n_left() == 0)
      in.fail("the file ends within an array of texts: it is cut off");
    else
      in.line();
  }
}

void skip_numbers(FileReader& in, std::int64_t n_tuples, std::size_t width, std::size_t n_bytes) {
  const std::size_t n =
      in.check_count(n_tuples, std::max<std::size_t>(1, width) * n_bytes, "tuples of an array") *
      width;
  if (in.is_binary) in.take(n * n_bytes, "an array");
  for (std::size_t k = 0; k < n && !in.is_binary; ++k) in.word("a number of an array");
}

void skip_bits(FileReader& in, std::int64_t n_tuples, std::size_t width) {
  if (!in.is_binary) return skip_numbers(in, n_tuples, width, 2);
  // Rounded towards what is negative, which is refused.
  const std::int64_t n_eights = n_tuples >> 3, n_beside = n_tuples & 7;
  const std::size_t n = in.check_count(n_eights, std::max<std::size_t>(1, width), "bits") * 8 +
                        static_cast<std::size_t>(n_beside);
  in.take((n * width + 7) / 8, "an array");
}

// n_tuples times `width` values, after the header.
void skip_values(FileReader& in, bool is_binary, const ValueType& type, std::int64_t n_tuples,
                 std::size_t width) {
  begin_data(in, is_binary);
  if (type.is_text)
    skip_texts(in, in.check_count(n_tuples, std::max<std::size_t>(1, width), "texts") * width);
  else if (type.is_bit)
    skip_bits(in, n_tuples, width);
  else
    skip_numbers(in, n_tuples, width, is_binary ? type.number.n_bytes : 2);
  in.is_binary = false;
}

std::size_t read_width(FileReader& in) {
  return in.check_count(in.integer("a number of components"), 1, "components");
}

void skip_field_array(FileReader& in, bool is_binary) {
  if (in_capital_letters(in.peek_word()) == "METADATA") {
    in.word("METADATA");
    skip_metadata(in);
  }
  in.word("the name of an array");
  const std::size_t width = read_width(in);
  const std::int64_t n_tuples = in.integer("a number of tuples");
  const ValueType type = read_value_type(in);
  skip_values(in, is_binary, type, n_tuples, width);
}

// Without moving on: binary data may begin in the next line.
bool is_before_table(const FileReader& in) {
  constexpr std::string_view keyword = "LOOKUP_TABLE";
  const std::string_view rest = in.rest();
  const std::size_t at = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
  return in_capital_letters(rest.substr(at, keyword.size())) == keyword;
}

void skip_scalars(FileReader& in, bool is_binary, std::int64_t n) {
  const ValueType type = read_value_type(in);
  const std::size_t width = in.is_at_line_end() ? 1 : read_width(in);
  if (is_before_table(in)) {
    in.word("LOOKUP_TABLE");
    in.word("the name of a table");
  }
  skip_values(in, is_binary, type, n, width);
}

// Colours are bytes in binary files.
constexpr ValueType colour{.number = {.is_float = false, .is_signed = false, .n_bytes = 1}};

// Of attributes that have as many components each, 0 for others.
std::size_t width_of(const std::string& keyword) {
  if (keyword == "VECTORS" || keyword == "NORMALS") return 3;
  if (keyword == "TENSORS") return 9;
  if (keyword == "TENSORS6") return 6;
  return keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS" ? 1 : 0;
}

}  // namespace

VtkNumber read_number_type(FileReader& in) {
  const std::string_view name = in.word("a type of numbers");
  const std::optional<VtkNumber> number = find_vtk_number(name);
  if (!number) in.fail("there is no type of numbers called " + in_quotes(name));
  return *number;
}

void begin_data(FileReader& in, bool is_binary) {
  if (is_binary) in.begin_binary(std::endian::native == std::endian::little);
}

void skip_metadata(FileReader& in) {
  in.line();
  while (in.n_left() > 0 && !in.line().empty()) continue;
}

void skip_field(FileReader& in, bool is_binary) {
  in.word("the name of a field");
  const std::size_t n = in.check_count(in.integer("the number of arrays"), 4, "arrays of a field");
  for (std::size_t k = 0; k < n; ++k) skip_field_array(in, is_binary);
}

bool skip_attribute(FileReader& in, bool is_binary, const std::string& keyword, std::int64_t n) {
  const bool has_width = keyword == "COLOR_SCALARS" || keyword == "TEXTURE_COORDINATES";
  const std::size_t width = width_of(keyword);
  if (!has_width && width == 0 && keyword != "SCALARS" && keyword != "LOOKUP_TABLE") return false;
  in.word("the name of an array");
  if (keyword == "SCALARS") {
    skip_scalars(in, is_binary, n);
  } else if (keyword == "LOOKUP_TABLE") {
    skip_values(in, is_binary, colour, in.integer("the size of a table"), 4);
  } else {
    const std::size_t own_width = has_width ? read_width(in) : width;
    const ValueType type = keyword == "COLOR_SCALARS" ? colour : read_value_type(in);
    skip_values(in, is_binary, type, n, own_width);
  }
  return true;
}

}  // namespace trocar
