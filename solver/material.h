// What tissue is made of: parameters of every material. The formulas are in material_<name>.h, one
// file each.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "solver/material_model.h"

namespace trocar {

// The isochoric stress relaxes by this share with this time constant.
struct PronyBranch {
  double share = 0;  // g of G(t) / G(0) = 1 - sum g (1 - exp(-t / tau)), > 0
  double time = 1;   // tau [s], > 0
  bool operator==(const PronyBranch&) const = default;
};

struct OgdenTerm {
  double mu = 0;     // share of the shear modulus [Pa], > 0, or 0: no term
  double alpha = 2;  // not 0
};

// Every model has density, poisson_ratio (which gives the bulk modulus K from the shear modulus mu
// at small strain) and prony; the others belong to the models named.
struct Material {
  MaterialModel model = MaterialModel::neo_hookean;
  // linear, St. Venant-Kirchhoff, neo-Hookean and the two with fibres (of what is between them)
  double young_modulus = 3000;        // [Pa], > 0
  double poisson_ratio = 0.45;        // in (-1, 0.5)
  double density = 1060;              // [kg/m^3], > 0
  double c10 = 0, c01 = 0;            // Mooney-Rivlin, mu = 2 (c10 + c01) [Pa]
  double c1 = 0, c2 = 0, c3 = 0;      // Yeoh, mu = 2 c1 [Pa]
  std::array<OgdenTerm, 3> ogden{};   // Ogden, mu = sum of theirs
  double eta = 0;                     // transversely isotropic: fibre modulus [Pa]
  double k1 = 0, k2 = 1, kappa = 0;   // Holzapfel-Gasser-Ogden: [Pa], 1, in [0, 1/3]
  double fibre_angle = 0;             // of its two families to `fibre`, 0: one family [rad]
  Vec3 fibre = Vec3(1, 0, 0);         // mean direction where Mesh::fibre gives none
  Vec3 fibre_normal = Vec3(0, 0, 1);  // of the plane in which the two families lie
  std::vector<PronyBranch> prony{};
};

// Lame parameters and bulk modulus at small strain, without fibres. [Pa]
double lame_lambda(const Material& material);
double lame_mu(const Material& material);
double bulk_modulus(const Material& material);

bool has_fibres(MaterialModel model);
// Whether one of them has a history.
bool is_viscous(std::span<const Material> materials);

}  // namespace trocar
