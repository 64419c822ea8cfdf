// The option --scale: what one unit of a mesh file is long.
#pragma once

#include <string>

namespace trocar {

// [m]; throws InputError unless it is a length above zero.
double read_scale(const std::string& text);

}  // namespace trocar
