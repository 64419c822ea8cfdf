#include "solver/material_setup.h"

namespace trocar {

void fill_material(const Material& material, double volume, std::span<double> value) {
  value[value_K_V] = bulk_modulus(material) * volume;
  value[value_mu_V] = lame_mu(material) * volume;
}

}  // namespace trocar
