// Words and arrays of legacy VTK files. Most arrays are of no use here and passed over, but they
// have to be whole: a file that ends within them is cut off.
#pragma once

#include <string>

#include "mesh/file_reader.h"
#include "mesh/vtk_cells.h"

namespace trocar {

// The next word as a type of numbers.
VtkNumber read_number_type(FileReader& in);
// Binary data begin in the line below their header and are big endian; in.is_binary while in them.
void begin_data(FileReader& in, bool is_binary);

// Each throws InputError where what it passes over is not whole. After their keyword:
// Names and units of the array above, up to an empty line.
void skip_metadata(FileReader& in);
void skip_field(FileReader& in, bool is_binary);
// SCALARS, VECTORS and so on, of n points or cells; false if the keyword is none of these.
bool skip_attribute(FileReader& in, bool is_binary, const std::string& keyword, std::int64_t n);

}  // namespace trocar
