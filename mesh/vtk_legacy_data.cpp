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

// The reader whose messages point to the name of the array.
FileReader at_array(const LegacyData& data, const LegacyData::Array& array) {
  return data.in.within(array.tag);
}

std::vector<double> read_numbers(FileReader& in, std::size_t n, const VtkNumber& number) {
  std::vector<double> value;
  value.reserve(n);
  for (std::size_t k = 0; k < n; ++k)
    value.push_back(
        in.is_binary ? load_real(in.take(number.n_bytes, "an array").data(), number, in.swaps_bytes)
                     : in.real("a number of an array"));
  return value;
}

// Where an array that is kept belongs; nullptr for others, which are noted.
std::optional<LegacyData::Array>* find_place(LegacyData& data, std::string_view name,
                                             std::size_t width) {
  const bool is_of_cells = data.of == LegacyData::Of::cells;
  if (is_of_cells && name == "region" && width == 1) return &data.region;
  if (is_of_cells && name == "fibre" && width == 3) return &data.fibre;
  if (is_of_cells) data.left_out.of_cells.emplace_back(name);
  if (data.of == LegacyData::Of::points) data.left_out.of_points.emplace_back(name);
  return nullptr;
}

struct LegacyHead {
  std::string_view name;
  ValueType type;
  std::int64_t n_tuples = 0;
  std::size_t width = 1;
};

// After the header.
void read_array(LegacyData& data, const LegacyHead& head) {
  const ValueType& type = head.type;
  std::optional<LegacyData::Array>* const place = find_place(data, head.name, head.width);
  if (place == nullptr || type.is_bit || type.is_text)
    return skip_values(data.in, data.is_binary, type, head.n_tuples, head.width);
  if (*place) data.in.fail("array " + in_quotes(head.name) + " stands here again");
  begin_data(data.in, data.is_binary);
  const std::size_t n_bytes = data.is_binary ? type.number.n_bytes : 2;
  const std::size_t n =
      data.in.check_count(head.n_tuples, head.width * n_bytes, "tuples of an array") * head.width;
  *place = {type.number.is_float, head.name, read_numbers(data.in, n, type.number)};
  data.in.is_binary = false;
}

std::size_t read_width(FileReader& in) {
  return in.check_count(in.integer("a number of components"), 1, "components");
}

void read_field_array(LegacyData& data) {
  FileReader& in = data.in;
  if (in_capital_letters(in.peek_word()) == "METADATA") {
    in.word("METADATA");
    skip_metadata(in);
  }
  LegacyHead head{.name = in.word("the name of an array"), .type = {}};
  head.width = read_width(in);
  head.n_tuples = in.integer("a number of tuples");
  head.type = read_value_type(in);
  read_array(data, head);
}

// Without moving on: binary data may begin in the next line.
bool is_before_table(const FileReader& in) {
  constexpr std::string_view keyword = "LOOKUP_TABLE";
  const std::string_view rest = in.rest();
  const std::size_t at = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
  return in_capital_letters(rest.substr(at, keyword.size())) == keyword;
}

void read_scalars(LegacyData& data, std::string_view name) {
  FileReader& in = data.in;
  LegacyHead head{.name = name, .type = read_value_type(in), .n_tuples = data.n};
  if (!in.is_at_line_end()) head.width = read_width(in);
  if (is_before_table(in)) {
    in.word("LOOKUP_TABLE");
    in.word("the name of a table");
  }
  read_array(data, head);
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

void read_field(LegacyData& data) {
  FileReader& in = data.in;
  in.word("the name of a field");
  const std::size_t n = in.check_count(in.integer("the number of arrays"), 4, "arrays of a field");
  for (std::size_t k = 0; k < n; ++k) read_field_array(data);
}

bool read_attribute(LegacyData& data, const std::string& keyword) {
  FileReader& in = data.in;
  const bool has_width = keyword == "COLOR_SCALARS" || keyword == "TEXTURE_COORDINATES";
  const std::size_t width = width_of(keyword);
  if (!has_width && width == 0 && keyword != "SCALARS" && keyword != "LOOKUP_TABLE") return false;
  const std::string_view name = in.word("the name of an array");
  if (keyword == "SCALARS") {
    read_scalars(data, name);
  } else if (keyword == "LOOKUP_TABLE") {
    skip_values(in, data.is_binary, colour, in.integer("the size of a table"), 4);
  } else {
    LegacyHead head{.name = name, .type = colour, .n_tuples = data.n, .width = width};
    if (has_width) head.width = read_width(in);
    if (keyword != "COLOR_SCALARS") head.type = read_value_type(in);
    read_array(data, head);
  }
  return true;
}

void keep_data(const LegacyData& data, VtkCells& cells) {
  const auto check_size = [&](const LegacyData::Array& array, std::size_t width) {
    if (array.value.size() != cells.type.size() * width)
      at_array(data, array)
          .fail(in_quotes(array.tag) + " is of " + std::to_string(array.value.size() / width) +
                " cells, but there are " + std::to_string(cells.type.size()));
  };
  if (data.region) {
    check_size(*data.region, 1);
    cells.region =
        make_vtk_regions(at_array(data, *data.region), data.region->value, data.region->is_float);
  }
  if (data.fibre) {
    check_size(*data.fibre, 3);
    const std::vector<double>& value = data.fibre->value;
    for (std::size_t k = 0; k < value.size(); k += 3)
      cells.fibre.emplace_back(value[k], value[k + 1], value[k + 2]);
  }
}

}  // namespace trocar
