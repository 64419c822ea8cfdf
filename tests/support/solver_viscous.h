// The material of the tests of viscoelasticity.
#pragma once

#include <utility>
#include <vector>

#include "solver_body.h"

namespace trocar {

inline constexpr double viscous_mu = 1000, viscous_K = 9000;  // [Pa]

inline Material viscous_material(std::vector<PronyBranch> prony,
                                 MaterialModel model = MaterialModel::neo_hookean) {
  Material material = material_of(model, viscous_mu, viscous_K);
  material.prony = std::move(prony);
  return material;
}

}  // namespace trocar
