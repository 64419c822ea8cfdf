// What tissue is made of: parameters of every material. The formulas are in material_<name>.h, one
// file each.
#pragma once

#include <cstdint>

namespace trocar {

enum class MaterialModel : std::uint8_t { linear, st_venant_kirchhoff, neo_hookean };

struct Material {
  MaterialModel model = MaterialModel::neo_hookean;
  double young_modulus = 3000;  // [Pa], > 0
  double poisson_ratio = 0.45;  // in (-1, 0.5)
  double density = 1060;        // [kg/m^3], > 0
};

// Lame parameters and bulk modulus of linear isotropic elasticity. [Pa]
double lame_lambda(const Material& material);
double lame_mu(const Material& material);
double bulk_modulus(const Material& material);

}  // namespace trocar
