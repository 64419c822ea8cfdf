// Elastic constants from Young's modulus and Poisson's ratio.
#include "solver/material.h"

namespace trocar {

double lame_lambda(const Material& material) {
  const double E = material.young_modulus, nu = material.poisson_ratio;
  return E * nu / ((1 + nu) * (1 - 2 * nu));
}

double lame_mu(const Material& material) {
  return material.young_modulus / (2 * (1 + material.poisson_ratio));
}

double bulk_modulus(const Material& material) {
  return material.young_modulus / (3 * (1 - 2 * material.poisson_ratio));
}

}  // namespace trocar
