// Legacy VTK files: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <algorithm>
#include <cmath>

#include "base/quoted.h"
#include "mesh/mesh_file_formats.h"
#include "mesh/vtk_legacy_data.h"

namespace trocar {

namespace {

struct LegacyReader {
  FileReader& in;
  RawMesh mesh;
  VtkCells cells;
  LegacyData data;
  bool is_binary = false;  // in.is_binary while inside binary data
  bool has_offset_layout = false;
  bool has_points = false, has_cells = false, has_types = false;
};

void expect_keyword(FileReader& in, std::string_view expected) {
  if (in_capital_letters(in.peek_word()) == expected)
    in.word("a keyword");
  else
    in.expect_word(expected);
}

std::size_t check_numbers(const LegacyReader& r, std::int64_t n, const VtkNumber& number,
                          const char* what) {
  return r.in.check_count(n, r.is_binary ? number.n_bytes : 2, what);
}

std::vector<std::int32_t> read_integers(LegacyReader& r, std::int64_t count,
                                        const VtkNumber& number, const char* what) {
  if (number.is_float) r.in.fail(std::string(what) + " should be integers");
  begin_data(r.in, r.is_binary);
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
  const VtkNumber number = read_number_type(r.in);
  begin_data(r.in, r.is_binary);
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
  VtkNumber number = read_number_type(r.in);
  r.cells.offset = read_integers(r, n, number, "the offsets");
  expect_keyword(r.in, "CONNECTIVITY");
  number = read_number_type(r.in);
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
  const std::string format = in_capital_letters(r.in.word("ASCII or BINARY"));
  if (format != "ASCII" && format != "BINARY")
    r.in.fail("ASCII or BINARY should stand here, not " + in_quotes(format));
  r.is_binary = r.data.is_binary = format == "BINARY";
  expect_keyword(r.in, "DATASET");
  const std::string kind = in_capital_letters(r.in.word("a kind of data set"));
  if (kind != "UNSTRUCTURED_GRID")
    r.in.fail("the data set is " + in_quotes(kind) + "; only UNSTRUCTURED_GRID is read");
}

void read_data(LegacyReader& r, const std::string& keyword) {
  if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
    r.data.of = keyword == "CELL_DATA" ? LegacyData::Of::cells : LegacyData::Of::points;
    r.data.n = r.in.integer("the number of points or cells with data");
    if (r.data.n < 0) r.in.fail("the number of points or cells is negative");
  } else if (r.data.of == LegacyData::Of::file) {
    r.in.fail("POINTS, CELLS or CELL_TYPES should stand here, not " + in_quotes(keyword));
  } else if (!read_attribute(r.data, keyword)) {
    r.in.fail("SCALARS, VECTORS, FIELD or other data should stand here, not " + in_quotes(keyword));
  }
}

void read_section(LegacyReader& r) {
  const std::string keyword = in_capital_letters(r.in.word("a section"));
  if (keyword == "POINTS")
    read_points(r);
  else if (keyword == "CELLS")
    read_cells(r);
  else if (keyword == "CELL_TYPES")
    read_types(r);
  else if (keyword == "METADATA")
    skip_metadata(r.in);
  else if (keyword == "FIELD")
    read_field(r.data);
  else
    read_data(r, keyword);
}

}  // namespace

RawMesh read_legacy_vtk(FileReader& in) {
  LegacyReader r{.in = in, .mesh = {}, .cells = {}, .data = {.in = in}};
  r.mesh.file = in.file();
  r.mesh.tag_word = "cell";
  read_header(r);
  while (!in.is_at_end()) read_section(r);
  const char* missing = !r.has_points ? "POINTS" : !r.has_cells ? "CELLS" : "CELL_TYPES";
  if (!r.has_points || !r.has_cells || !r.has_types)
    in.fail_file(std::string("holds no ") + missing);
  keep_data(r.data, r.cells);
  add_vtk_cells(in, r.cells, r.mesh);
  r.mesh.left_out = left_out_text(r.data.left_out);
  return std::move(r.mesh);
}

}  // namespace trocar
