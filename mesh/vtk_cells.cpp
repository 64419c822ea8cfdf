// Numbers and cells of VTK files.
#include "mesh/vtk_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/log.h"
#include "base/number_text.h"
#include "base/quoted.h"
#include "mesh/raw_mesh_groups.h"

namespace trocar {

std::optional<VtkNumber> find_vtk_number(std::string_view name) {
  struct Entry {
    std::string_view name;
    VtkNumber number;
  };
  constexpr VtkNumber i8{false, true, 1}, u8{false, false, 1}, i16{false, true, 2},
      u16{false, false, 2}, i32{false, true, 4}, u32{false, false, 4}, i64{false, true, 8},
      u64{false, false, 8}, f32{true, true, 4}, f64{true, true, 8};
  static constexpr Entry entries[] = {
      {"float", f32},         {"double", f64},         {"int", i32},
      {"unsigned_int", u32},  {"long", i64},           {"unsigned_long", u64},
      {"short", i16},         {"unsigned_short", u16}, {"char", i8},
      {"signed_char", i8},    {"unsigned_char", u8},   {"vtktypeint64", i64},
      {"vtktypeuint64", u64}, {"vtkIdType", i32},      {"vtkidtype", i32},
      {"Float32", f32},       {"Float64", f64},        {"Int8", i8},
      {"UInt8", u8},          {"Int16", i16},          {"UInt16", u16},
      {"Int32", i32},         {"UInt32", u32},         {"Int64", i64},
      {"UInt64", u64},
  };
  for (const Entry& entry : entries)
    if (entry.name == name) return entry.number;
  return std::nullopt;
}

double load_real(const char* from, const VtkNumber& number, bool swaps) {
  if (!number.is_float) return static_cast<double>(load_integer(from, number, swaps));
  return number.n_bytes == 4 ? FileReader::load_number<float>(from, swaps)
                             : FileReader::load_number<double>(from, swaps);
}

template <class Signed, class Unsigned>
static std::int64_t load_as(const char* from, bool is_signed, bool swaps) {
  if (is_signed) return static_cast<std::int64_t>(FileReader::load_number<Signed>(from, swaps));
  return static_cast<std::int64_t>(FileReader::load_number<Unsigned>(from, swaps));
}

std::int64_t load_integer(const char* from, const VtkNumber& number, bool swaps) {
  switch (number.n_bytes) {
    case 1:
      return load_as<std::int8_t, std::uint8_t>(from, number.is_signed, swaps);
    case 2:
      return load_as<std::int16_t, std::uint16_t>(from, number.is_signed, swaps);
    case 4:
      return load_as<std::int32_t, std::uint32_t>(from, number.is_signed, swaps);
    default:
      return load_as<std::int64_t, std::uint64_t>(from, number.is_signed, swaps);
  }
}

std::int32_t fit_int32(const FileReader& in, std::int64_t value, const char* what) {
  if (value < std::numeric_limits<std::int32_t>::min() ||
      value > std::numeric_limits<std::int32_t>::max())
    in.fail(std::string(what) + " is " + std::to_string(value) + ", beyond 32 bits");
  return static_cast<std::int32_t>(value);
}

std::vector<std::int32_t> make_vtk_regions(const FileReader& at, std::span<const double> number,
                                           bool is_float) {
  constexpr double most = std::numeric_limits<std::int32_t>::max() - 1;
  const auto is_wrong = [&](double k) { return !(k >= 0 && k <= most && k == std::floor(k)); };
  const auto wrong = std::ranges::find_if(number, is_wrong);
  if (wrong != number.end() && !is_float)
    at.fail("region " + shortest_text(*wrong) + " is no whole number between 0 and 2147483646");
  if (wrong != number.end()) {
    log_warning(at.file() + ": its cell array \"region\" is left out: regions are whole numbers");
    return {};
  }
  std::vector<std::int32_t> region;
  region.reserve(number.size());
  for (const double k : number) region.push_back(static_cast<std::int32_t>(k) + 1);
  return region;
}

static std::string quoted_list(std::span<const std::string> names) {
  constexpr std::size_t most = 10;
  std::string list;
  for (const std::string& name : names.first(std::min(most, names.size())))
    list += (list.empty() ? "" : ", ") + in_quotes(name);
  if (names.size() > most) list += " and " + std::to_string(names.size() - most) + " more";
  return list;
}

std::string left_out_text(const VtkLeftOut& left_out) {
  std::string list;
  if (!left_out.of_cells.empty()) list = "cell data " + quoted_list(left_out.of_cells);
  if (!left_out.of_points.empty())
    list += (list.empty() ? "" : " and ") + std::string("point data ") +
            quoted_list(left_out.of_points);
  if (list.empty()) return "";
  return "its " + list +
         " are left out; read are cell data called \"region\" (a whole number each) and "
         "\"fibre\" (three numbers)";
}

namespace {

enum VtkType {
  vtk_vertex = 1,
  vtk_poly_vertex = 2,
  vtk_line = 3,
  vtk_poly_line = 4,
  vtk_triangle = 5,
  vtk_pixel = 8,
  vtk_quad = 9,
  vtk_tetra = 10,
  vtk_voxel = 11,
  vtk_hexahedron = 12,
  vtk_wedge = 13,
  vtk_pyramid = 14
};

std::string unsupported_name(std::int32_t type) {
  if (type == vtk_wedge) return "a prism";
  if (type == vtk_pyramid) return "a pyramid";
  const bool is_second_order = (type >= 21 && type <= 37);
  return is_second_order ? "of second order" : "of a kind that is not read";
}

[[noreturn]] void fail_cell(const FileReader& in, std::size_t c, const std::string& sentence) {
  in.fail_file("cell " + std::to_string(c) + " " + sentence);
}

// nullopt for vertices and lines.
std::optional<CellKind> cell_kind(const FileReader& in, const VtkCells& cells, std::size_t c) {
  switch (cells.type[c]) {
    case vtk_vertex:
    case vtk_poly_vertex:
    case vtk_line:
    case vtk_poly_line:
      return std::nullopt;
    case vtk_triangle:
      return CellKind::triangle;
    case vtk_pixel:
    case vtk_quad:
      return CellKind::quadrangle;
    case vtk_tetra:
      return CellKind::tetrahedron;
    case vtk_voxel:
    case vtk_hexahedron:
      return CellKind::hexahedron;
    default:
      fail_cell(
          in, c,
          "is " + unsupported_name(cells.type[c]) + " (VTK type " + std::to_string(cells.type[c]) +
              "); triangles, tetrahedra, hexahedra and voxels are read (types 5, 10, 12, 11)");
  }
}

void check_size(const FileReader& in, const VtkCells& cells, std::size_t c,
                std::optional<CellKind> kind) {
  const std::int32_t n = cells.offset[c + 1] - cells.offset[c], type = cells.type[c];
  const std::int32_t least = type == vtk_line || type == vtk_poly_line ? 2 : 1;
  const bool is_right = kind ? n == n_cell_corners(*kind)
                             : n >= least && (n == least || type % 2 == 0);  // poly types are even
  if (!is_right)
    fail_cell(in, c,
              "has " + std::to_string(n) + " corners, which does not fit VTK type " +
                  std::to_string(type));
}

void check_offsets(const FileReader& in, const VtkCells& cells) {
  const std::size_t n = cells.type.size();
  if (cells.offset.size() != n + 1)
    in.fail_file("has " + std::to_string(n) + " cell types, but " +
                 std::to_string(static_cast<std::int64_t>(cells.offset.size()) - 1) + " cells");
  std::int32_t before = 0;
  for (std::size_t c = 0; c <= n; ++c) {
    const std::int32_t offset = cells.offset[c];
    if (offset < before || (c == 0 && offset != 0) ||
        static_cast<std::size_t>(offset) > cells.connectivity.size())
      in.fail_file("the offset of cell " + std::to_string(c) + " is " + std::to_string(offset) +
                   ", not between " + std::to_string(before) + " and " +
                   std::to_string(cells.connectivity.size()));
    before = offset;
  }
  if (static_cast<std::size_t>(before) != cells.connectivity.size())
    in.fail_file("the last offset is " + std::to_string(before) + ", but the cells have " +
                 std::to_string(cells.connectivity.size()) + " corners");
}

// Pixels and voxels count their corners along x, then y, then z.
void order_corners(std::int32_t type, std::span<std::int32_t> corner) {
  if (type == vtk_pixel || type == vtk_voxel) std::swap(corner[2], corner[3]);
  if (type == vtk_voxel) std::swap(corner[6], corner[7]);
}

int highest_dimension(const RawMesh& raw) {
  int highest = 0;
  for (const CellKind kind : raw.cell_kind) highest = std::max(highest, cell_dimension(kind));
  return highest;
}

// Regions of a VTK file have numbers only; in cells below the elements they mean nothing.
void name_regions(RawMesh& raw) {
  const int dimension = highest_dimension(raw);
  for (std::int32_t c = 0; c < raw.n_cells(); ++c)
    if (cell_dimension(raw.cell_kind[c]) < dimension) raw.cell_group[c] = 0;
  make_group_lists(raw);
  if (raw.group_tag.size() < 2 || raw.group_tag.size() > most_groups) return;
  for (const std::int32_t tag : raw.group_tag)
    raw.named_groups.push_back({dimension, tag, "region-" + std::to_string(tag - 1)});
}

}  // namespace

void add_vtk_cells(const FileReader& in, const VtkCells& cells, RawMesh& raw) {
  check_offsets(in, cells);
  const std::size_t n = cells.type.size();
  reserve_cells(raw, n);
  raw.cell_corner.reserve(cells.connectivity.size());
  std::array<std::int32_t, max_corners> corner{};
  for (std::size_t c = 0; c < n; ++c) {
    const std::optional<CellKind> kind = cell_kind(in, cells, c);
    check_size(in, cells, c, kind);
    const auto begin = cells.connectivity.begin() + cells.offset[c];
    const auto end = cells.connectivity.begin() + cells.offset[c + 1];
    for (auto i = begin; i != end; ++i)
      if (*i < 0 || static_cast<std::size_t>(*i) >= raw.X.size())
        fail_cell(in, c,
                  "refers to point " + std::to_string(*i) + ", but the points run from 0 to " +
                      std::to_string(static_cast<std::int64_t>(raw.X.size()) - 1));
    if (!kind) continue;
    std::copy(begin, end, corner.begin());
    const std::span<std::int32_t> corners(corner.data(), static_cast<std::size_t>(end - begin));
    order_corners(cells.type[c], corners);
    const std::int32_t region = cells.region.empty() ? 0 : cells.region[c];
    if (!cells.fibre.empty()) raw.fibre.emplace_back(raw.n_cells(), cells.fibre[c]);
    add_cell(raw, *kind, corners, static_cast<std::int64_t>(c), region);
  }
  name_regions(raw);
}

}  // namespace trocar
