// What legacy VTK and VTU share: types of numbers, and cells as type, offset and connectivity.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/file_reader.h"
#include "mesh/raw_mesh.h"

namespace trocar {

// A number as VTK files store it, little or big endian.
struct VtkNumber {
  bool is_float = false;
  bool is_signed = true;
  std::size_t n_bytes = 4;
};
// By the name in legacy files ("vtktypeint64") or in VTU files ("Int64").
std::optional<VtkNumber> find_vtk_number(std::string_view name);
double load_real(const char* from, const VtkNumber& number, bool swaps);
// Throws nothing: what 64 signed bits can't hold comes out negative. Not for floats.
std::int64_t load_integer(const char* from, const VtkNumber& number, bool swaps);
// Throws InputError at the reader's place where a value does not fit 32 bits.
std::int32_t fit_int32(const FileReader& in, std::int64_t value, const char* what);

struct VtkCells {
  std::vector<std::int32_t> type;          // (n_cells)
  std::vector<std::int32_t> offset;        // (n_cells + 1)
  std::vector<std::int32_t> connectivity;  // (offset.back())
  std::vector<std::int32_t> region;        // (n_cells) or empty
  std::vector<Vec3> fibre;                 // (n_cells) or empty
};
// Regions by the numbers of cells, from 1 on, since group 0 is none. Floats that are not whole are
// something else: none then, with a warning. Throws InputError at the reader's place where an
// integer is no region.
std::vector<std::int32_t> make_vtk_regions(const FileReader& at, std::span<const double> number,
                                           bool is_float);
// Arrays of a file that nothing here uses.
struct VtkLeftOut {
  std::vector<std::string> of_cells, of_points;
};
// What to warn of, "" if there are none.
std::string left_out_text(const VtkLeftOut& left_out);

// Adds the cells to raw.X and so on. Vertices and lines are left out: they carry nothing.
// Throws InputError naming the cell.
void add_vtk_cells(const FileReader& in, const VtkCells& cells, RawMesh& raw);

}  // namespace trocar
