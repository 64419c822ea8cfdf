// Constants of a material in an element's block, and the check of what a user gives.
#pragma once

#include <span>

#include "solver/element_setup.h"
#include "solver/material.h"

namespace trocar {

inline constexpr int max_material_values = 2;
inline constexpr int max_values = max_material_values + max_element_values;

// The first values of an element of the given volume [m^3]; layout in block_data.h and
// material_<name>.h.
void fill_material(const Material& material, double volume, std::span<double> value);

}  // namespace trocar
