// Elastic constants at small strain.
#include "solver/material.h"

#include <algorithm>

namespace trocar {

double lame_mu(const Material& material) {
  switch (material.model) {
    case MaterialModel::mooney_rivlin:
      return 2 * (material.c10 + material.c01);
    case MaterialModel::yeoh:
      return 2 * material.c1;
    case MaterialModel::ogden:
      return material.ogden[0].mu + material.ogden[1].mu + material.ogden[2].mu;
    default:
      return material.young_modulus / (2 * (1 + material.poisson_ratio));
  }
}

double lame_lambda(const Material& material) {
  const double nu = material.poisson_ratio;
  return 2 * lame_mu(material) * nu / (1 - 2 * nu);
}

double bulk_modulus(const Material& material) {
  const double nu = material.poisson_ratio;
  return 2 * lame_mu(material) * (1 + nu) / (3 * (1 - 2 * nu));
}

bool has_fibres(MaterialModel model) {
  return model == MaterialModel::transversely_isotropic ||
         model == MaterialModel::holzapfel_gasser_ogden;
}

bool is_viscous(std::span<const Material> materials) {
  return std::any_of(materials.begin(), materials.end(),
                     [](const Material& material) { return !material.prony.empty(); });
}

}  // namespace trocar
