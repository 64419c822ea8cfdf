// Parameters of materials to constants of elements.
#include "solver/material_setup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/law_of_material.h"
#include "solver/viscous_step.h"

namespace trocar {

namespace {

// cos and sin for |x| <= pi / 2 without libm: every machine gives the same bits.
struct Turn {
  double cosine = 1, sine = 0;
};

Turn turn_of(double x) {
  Turn turn{.cosine = 1, .sine = x};
  double cosine_term = 1, sine_term = x;
  for (int k = 1; k <= 12; ++k) {
    cosine_term *= -x * x / ((2 * k - 1) * (2 * k));
    sine_term *= -x * x / ((2 * k) * (2 * k + 1));
    turn.cosine += cosine_term;
    turn.sine += sine_term;
  }
  return turn;
}

// The two families lie at +- fibre_angle about `fibre` in the plane across fibre_normal.
std::array<Vec3, 2> families_of(const Material& material, const Vec3& fibre) {
  Vec3 across = material.fibre_normal.cross(fibre);
  const double length = std::sqrt(across.dot(across));
  if (length > 0) across /= length;
  const Turn turn = turn_of(material.fibre_angle);
  return {turn.cosine * fibre + turn.sine * across, turn.cosine * fibre - turn.sine * across};
}

void put(const Vec3& direction, int at, std::span<double> value) {
  for (int i = 0; i < 3; ++i) value[at + i] = direction[i];
}

void fill_ogden(const Material& material, double volume, std::span<double> value) {
  using M = MaterialOgden;
  for (int p = 0; p < M::n_terms; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const OgdenTerm& term = material.ogden[at];
    value[M::value_mu_p_V + at] = term.mu * volume;
    value[M::value_alpha + at] = term.alpha;
    value[M::value_inverse_alpha + at] = 1 / term.alpha;
  }
}

void fill_holzapfel(const Material& material, double volume, const Vec3& fibre,
                    std::span<double> value) {
  using M = MaterialHolzapfelGasserOgden;
  value[M::value_k2] = material.k2;
  value[M::value_kappa] = material.kappa;
  value[M::value_most_E] = std::sqrt(M::largest_exponent / material.k2);
  value[M::value_half_by_k2] = 0.5 / material.k2;
  const std::array<Vec3, 2> family = families_of(material, fibre);
  const int n = material.fibre_angle > 0 ? 2 : 1;
  for (int k = 0; k < n; ++k) {
    value[M::value_family + 4 * k] = material.k1 * volume;
    put(family[k], M::value_family + 4 * k + 1, value);
  }
}

bool is_positive(double x) {
  return x > 0 && std::isfinite(x);
}
bool is_not_negative(double x) {
  return x >= 0 && std::isfinite(x);
}

MaterialFault fault_of_ogden(const Material& material) {
  for (const OgdenTerm& term : material.ogden)
    if (!is_not_negative(term.mu) || term.alpha == 0 || !std::isfinite(term.alpha))
      return {"ogden", "each Ogden term needs mu > 0 and an alpha that is not 0"};
  return {};
}

MaterialFault fault_of_fibres(const Material& material) {
  const Vec3 across = material.fibre_normal.cross(material.fibre);
  if (!is_positive(material.fibre.dot(material.fibre))) return {"fibre", "fibre must not be zero"};
  if (!is_not_negative(material.eta)) return {"eta", "eta must not be negative"};
  if (!is_not_negative(material.k1) || !is_positive(material.k2))
    return {"k1", "k1 must not be negative, k2 must be positive"};
  if (!(material.kappa >= 0 && material.kappa <= 1.0 / 3))
    return {"kappa", "kappa must be in [0, 1/3]"};
  if (!(material.fibre_angle >= 0 && material.fibre_angle <= 1.5707963267948966))
    return {"fibre_angle", "fibre_angle must be between 0 and 90 degrees"};
  if (material.fibre_angle > 0 && !is_positive(across.dot(across)))
    return {"fibre_normal", "fibre_normal must not be zero or parallel to fibre"};
  return {};
}

MaterialFault fault_of_prony(const Material& material) {
  double sum = 0;
  for (const PronyBranch& branch : material.prony) {
    if (!is_positive(branch.share) || !is_positive(branch.time))
      return {"prony", "share and time of each prony branch must be positive"};
    sum += branch.share;
  }
  if (sum > 1) return {"prony", "the shares of the prony branches must not add up to more than 1"};
  if (material.prony.size() > max_prony_branches)
    return {"prony",
            "at most " + std::to_string(max_prony_branches) + " prony branches are allowed"};
  return {};
}

}  // namespace

void fill_material(const Material& material, double volume, const Vec3& fibre,
                   std::span<double> value) {
  value[value_K_V] = bulk_modulus(material) * volume;
  value[value_mu_V] = lame_mu(material) * volume;
  switch (material.model) {
    case MaterialModel::mooney_rivlin:
      value[MaterialMooneyRivlin::value_c10_V] = material.c10 * volume;
      value[MaterialMooneyRivlin::value_c01_V] = material.c01 * volume;
      break;
    case MaterialModel::yeoh:
      value[MaterialYeoh::value_c2_V] = material.c2 * volume;
      value[MaterialYeoh::value_c3_V] = material.c3 * volume;
      break;
    case MaterialModel::ogden:
      fill_ogden(material, volume, value);
      break;
    case MaterialModel::transversely_isotropic:
      value[MaterialTransverselyIsotropic::value_eta_V] = material.eta * volume;
      put(fibre, MaterialTransverselyIsotropic::value_a0, value);
      break;
    case MaterialModel::holzapfel_gasser_ogden:
      fill_holzapfel(material, volume, fibre, value);
      break;
    default:
      break;
  }
}

Vec3 unit_fibre(const Material& material) {
  return material.fibre / std::sqrt(material.fibre.dot(material.fibre));
}

MaterialFault fault_of(const Material& material) {
  if (!is_positive(lame_mu(material)) || !is_positive(material.density) ||
      !(material.poisson_ratio > -1 && material.poisson_ratio < 0.5))
    return {material.model == MaterialModel::mooney_rivlin ? "c10" : "young_modulus",
            "shear modulus and density must be positive, poisson_ratio between -1 and 0.5 (got " +
                std::to_string(lame_mu(material)) + " Pa, " + std::to_string(material.density) +
                " kg/m^3, " + std::to_string(material.poisson_ratio) + ")"};
  MaterialFault fault;
  if (material.model == MaterialModel::ogden) fault = fault_of_ogden(material);
  if (fault.sentence.empty() && has_fibres(material.model)) fault = fault_of_fibres(material);
  return fault.sentence.empty() ? fault_of_prony(material) : fault;
}

double stiffening_at_rest(const Material& material) {
  double result = 1;
  with_law_of(material, unit_fibre(material),
              [&]<class Law>(std::type_identity<Law>, const auto& values) {
                result = Law::stiffening(Tensor<double>{}, values);
              });
  return result;
}

}  // namespace trocar
