// Constants of a material in an element's block, and the check of what a user gives.
#pragma once

#include <span>
#include <string>

#include "solver/element_setup.h"
#include "solver/material.h"

namespace trocar {

inline constexpr int max_material_values = 14;  // Holzapfel-Gasser-Ogden
inline constexpr int max_values = max_material_values + max_element_values;

// The first values of an element of the given volume [m^3] and fibre direction (a unit vector);
// layout in block_data.h and material_<name>.h.
void fill_material(const Material& material, double volume, const Vec3& fibre,
                   std::span<double> value);
// Of an element whose mesh gives no direction.
Vec3 unit_fibre(const Material& material);

// What is wrong with a material: a member, and the sentence, "" for a sound one.
struct MaterialFault {
  std::string member{};
  std::string sentence{};
};
MaterialFault fault_of(const Material& material);

// Growth of the bound of omega^2 at rest against that of lambda and mu alone: what fibres add.
double stiffening_at_rest(const Material& material);

}  // namespace trocar
