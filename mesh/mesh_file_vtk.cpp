// Legacy VTK files: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/quoted.h"
#include "mesh/mesh_file_formats.h"
#include "mesh/vtk_cells.h"

namespace trocar {

namespace {

struct LegacyReader {
  ByteReader& in;
  RawMesh mesh;
  VtkCells cells;
  bool is_binary = false;  // in.is_binary while inside binary data
  bool has_offset_layout = false;
  bool has_points = false, has_cells = false, has_types = false;
};

// Keywords count in any case.
std::string upper(std::string_view word) {
  std::string text(word);
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

void expect_keyword(ByteReader& in, std::string_view expected) {
  if (upper(in.peek_word()) == expected)
    in.word("a keyword");
  else
    in.expect_word(expected);
}

VtkNumber number_type(ByteReader& in) {
  const std::string_view name = in.word("a type of numbers");
  const std::optional<VtkNumber> number = find_vtk_number(name);
  if (!number) in.fail("there is no type of numbers called " + in_quotes(name));
  return *number;
}

// Binary data begin in the line below their header and are big endian.
void begin_data(LegacyReader& r) {
  if (!r.is_binary) return;
  if (!r.in.is_at_line_end()) r.in.fail("nothing may stand before the binary data in its line");
  r.in.line();
  r.in.is_binary = true;
  r.in.swaps_bytes = std::endian::native == std::endian::little;
}

std::size_t check_numbers(const LegacyReader& r, std::int64_t n, const VtkNumber& number,
                          const char* what) {
  return r.in.check_count(n, r.is_binary ? number.n_bytes : 2, what);
}

std::vector<std::int32_t> read_integers(LegacyReader& r, std::int64_t count,
                                        const VtkNumber& number, const char* what) {
  if (number.is_float) r.in.fail(std::string(what) + " should be integers");
  begin_data(r);
  std::vector<std::int32_t> values(check_numbers(r, count, number, what));
  for (std::int32_t& value : values) {
    const std::int64_t wide =
        r.is_binary ? load_integer(r.in.take(number.n_bytes, what).data(), number, r.in.swaps_bytes)
                    : r.in.integer(what);
    value = fit_int32(r.in, wide, what);
  }
  r.in.is_binary = false;
  return values;
}

double read_coordinate(LegacyReader& r, const VtkNumber& number) {
  if (!r.is_binary) return r.in.real("a coordinate");
  const double x =
      load_real(r.in.take(number.n_bytes, "the points").data(), number, r.in.swaps_bytes);
  if (!std::isfinite(x)) r.in.fail("a coordinate is not finite");
  return x;
}

void read_points(LegacyReader& r) {
  if (r.has_points) r.in.fail("POINTS stands here again");
  r.has_points = true;
  const std::int64_t count = r.in.integer("the number of points");
  const VtkNumber number = number_type(r.in);
  begin_data(r);
  const std::size_t n = r.in.check_count(count, 3 * (r.is_binary ? number.n_bytes : 2), "points");
  if (n > 0x7fffffff) r.in.fail("there are more than 2147483647 points");
  r.mesh.X.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = read_coordinate(r, number);
    r.mesh.X.push_back(x);
  }
  r.in.is_binary = false;
}

// Up to version 4.2: number of corners, corners, cell after cell.
void split_cells(LegacyReader& r, std::size_t n, const std::vector<std::int32_t>& list) {
  std::size_t at = 0;
  r.cells.offset.reserve(n + 1);
  r.cells.connectivity.reserve(list.size() - std::min(n, list.size()));
  r.cells.offset.push_back(0);
  for (std::size_t c = 0; c < n; ++c) {
    if (at == list.size() || list[at] < 0 ||
        static_cast<std::size_t>(list[at]) > list.size() - at - 1)
      r.in.fail("cell " + std::to_string(c) + " does not fit into the " +
                std::to_string(list.size()) + " numbers of CELLS");
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    r.cells.connectivity.insert(r.cells.connectivity.end(), begin, begin + list[at]);
    r.cells.offset.push_back(static_cast<std::int32_t>(r.cells.connectivity.size()));
    at += 1 + static_cast<std::size_t>(list[at]);
  }
  if (at != list.size())
    r.in.fail("the cells fill " + std::to_string(at) + " of the " + std::to_string(list.size()) +
              " numbers of CELLS");
}

void read_cells(LegacyReader& r) {
  if (r.has_cells) r.in.fail("CELLS stands here again");
  r.has_cells = true;
  const std::int64_t n = r.in.integer("the number of cells");
  const std::int64_t size = r.in.integer("the size of CELLS");
  if (!r.has_offset_layout) {
    const std::size_t n_cells = r.in.check_count(n, r.is_binary ? 4 : 2, "cells");
    split_cells(r, n_cells, read_integers(r, size, VtkNumber{}, "numbers of the cells"));
    return;
  }
  expect_keyword(r.in, "OFFSETS");
  VtkNumber number = number_type(r.in);
  r.cells.offset = read_integers(r, n, number, "the offsets");
  expect_keyword(r.in, "CONNECTIVITY");
  number = number_type(r.in);
  r.cells.connectivity = read_integers(r, size, number, "the connectivity");
}

void read_types(LegacyReader& r) {
  // So that a file cut off within CELLS can't look complete.
  if (!r.has_cells) r.in.fail("CELLS should stand before CELL_TYPES");
  if (r.has_types) r.in.fail("CELL_TYPES stands here again");
  r.has_types = true;
  const std::int64_t n = r.in.integer("the number of cell types");
  r.cells.type = read_integers(r, n, VtkNumber{}, "the cell types");
}

// Names and units of the array above, up to an empty line.
void skip_metadata(ByteReader& in) {
  in.line();
  while (in.n_left() > 0 && !in.line().empty()) continue;
}

void skip_field_array(LegacyReader& r) {
  if (upper(r.in.peek_word()) == "METADATA") skip_metadata(r.in);
  r.in.word("the name of an array");
  const std::size_t width =
      r.in.check_count(r.in.integer("a number of components"), 1, "components");
  const std::int64_t n_tuples = r.in.integer("a number of tuples");
  r.in.check_count(n_tuples, 1, "tuples");
  const VtkNumber number = number_type(r.in);
  begin_data(r);
  const std::size_t n_bytes = r.is_binary ? number.n_bytes : 2;
  const std::size_t n =
      r.in.check_count(n_tuples, std::max<std::size_t>(1, width) * n_bytes, "tuples") * width;
  if (r.is_binary) r.in.take(n * n_bytes, "an array");
  for (std::size_t k = 0; k < n && !r.is_binary; ++k) r.in.word("a number of an array");
  r.in.is_binary = false;
}

void skip_field(LegacyReader& r) {
  r.in.word("the name of a field");
  const std::size_t n =
      r.in.check_count(r.in.integer("the number of arrays"), 4, "arrays of a field");
  for (std::size_t k = 0; k < n; ++k) skip_field_array(r);
}

void read_header(LegacyReader& r) {
  const std::string_view first = r.in.line();
  constexpr std::string_view start = "# vtk DataFile Version ";
  if (!first.starts_with(start))
    r.in.fail("the first line should be \"# vtk DataFile Version 4.2\"");
  const std::string_view version = first.substr(start.size());
  r.has_offset_layout = version.starts_with("5");
  if (version.empty() || version[0] < '1' || version[0] > '5')
    r.in.fail("version " + in_quotes(version) + " is not one of 1.0 to 5.1");
  r.in.line();
  const std::string format = upper(r.in.word("ASCII or BINARY"));
  if (format != "ASCII" && format != "BINARY")
    r.in.fail("ASCII or BINARY should stand here, not " + in_quotes(format));
  r.is_binary = format == "BINARY";
  expect_keyword(r.in, "DATASET");
  const std::string kind = upper(r.in.word("a kind of data set"));
  if (kind != "UNSTRUCTURED_GRID")
    r.in.fail("the data set is " + in_quotes(kind) + "; only UNSTRUCTURED_GRID is read");
}

// False where the data on points and cells begin, which are of no use here.
bool read_section(LegacyReader& r) {
  const std::string keyword = upper(r.in.word("a section"));
  if (keyword == "POINTS")
    read_points(r);
  else if (keyword == "CELLS")
    read_cells(r);
  else if (keyword == "CELL_TYPES")
    read_types(r);
  else if (keyword == "METADATA")
    skip_metadata(r.in);
  else if (keyword == "FIELD")
    skip_field(r);
  else if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
    return false;
  else
    r.in.fail("POINTS, CELLS or CELL_TYPES should stand here, not " + in_quotes(keyword));
  return true;
}

}  // namespace

RawMesh read_legacy_vtk(ByteReader& in) {
  LegacyReader r{.in = in, .mesh = {}, .cells = {}};
  r.mesh.file = in.file();
  r.mesh.tag_word = "cell";
  read_header(r);
  while (!in.is_at_end() && read_section(r)) continue;
  const char* missing = !r.has_points ? "POINTS" : !r.has_cells ? "CELLS" : "CELL_TYPES";
  if (!r.has_points || !r.has_cells || !r.has_types)
    in.fail_file(std::string("holds no ") + missing);
  add_vtk_cells(in, r.cells, r.mesh);
  return std::move(r.mesh);
}

}  // namespace trocar
