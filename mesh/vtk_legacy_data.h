// Words and arrays of legacy VTK files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/file_reader.h"
#include "mesh/vtk_cells.h"

namespace trocar {

// The next word as a type of numbers.
VtkNumber read_number_type(FileReader& in);
// Binary data begin in the line below their header and are big endian; in.is_binary while in them.
void begin_data(FileReader& in, bool is_binary);

// The data of a file. Two arrays of cells are kept; the others are passed over and noted, but they
// have to be whole.
struct LegacyData {
  FileReader& in;
  bool is_binary = false;  // in.is_binary while inside binary data
  enum class Of { file, cells, points } of = Of::file;
  std::int64_t n = 0;  // cells or points that have the data
  struct Array {
    bool is_float = false;
    std::string_view tag;  // for messages
    std::vector<double> value;
  };
  std::optional<Array> region, fibre;
  VtkLeftOut left_out;
};

// Each throws InputError where what it passes over is not whole. After their keyword:
// Names and units of the array above, up to an empty line.
void skip_metadata(FileReader& in);
void read_field(LegacyData& data);
// SCALARS, VECTORS and so on, of n points or cells; false if the keyword is none of these.
bool read_attribute(LegacyData& data, const std::string& keyword);
// Throws InputError where there are not as many of them as cells.
void keep_data(const LegacyData& data, VtkCells& cells);

}  // namespace trocar
