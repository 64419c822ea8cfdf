// Transversely isotropic material: neo-Hookean with fibres that resist stretch and compression,
// W = mu/2 (I1bar - 3) + eta/2 (I4bar - 1)^2 + K/2 (J - 1)^2.
#pragma once

#include "solver/fibre.h"
#include "solver/material_model.h"
#include "solver/tangent_bound_below_floor.h"

namespace trocar {

struct MaterialTransverselyIsotropic : Decoupled<MaterialTransverselyIsotropic> {
  static constexpr MaterialModel model = MaterialModel::transversely_isotropic;
  static constexpr int value_eta_V = 2, value_a0 = 3;
  static constexpr int n_values = 6;

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    const Fibre<Pack> fibre = fibre_of(d, value, value_a0);
    const Pack power = 1.0 + d.iso.q, c = tension(d, fibre, value);
    Tensor<Pack> P = stress_of_I1bar(d, Pack(value(value_mu_V) * power),
                                     Pack(pressure + fibre_pressure(d, fibre, c)));
    add_fibre_stress(fibre, c, P);
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    const Pack e = fibre_of(d, value, value_a0).I4bar_1;
    return 0.5 * (value(value_mu_V) * d.I1bar_3 + value(value_eta_V) * e * e);
  }

  // Beside the tension's terms: eta (dI4bar)^2, |dI4bar| <= 2 (1+q) slope |dF|.
  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    const Pack mu = value(value_mu_V), power = 1.0 + d.iso.q;
    const Fibre<Pack> fibre = fibre_of(d, value, value_a0);
    Stretches<Pack> x;
    find_stretches(d, x);
    const Pack slope2 = fibre_slope2(x, fibre);
    TangentTerms<Pack> terms = terms_of_I1bar(x, Pack(0.5 * mu), zero_of(mu));
    add_fibre_terms(x, fibre, tension(d, fibre, value), square_root(slope2), terms);
    terms.square += 4.0 * value(value_eta_V) * power * power * slope2;
    Pack result;
    bound_tangent(d, x, terms, value(value_K_V), mu, result);
    if (is_above_floor(d)) return result;
    const FloorBound<Pack> b = floor_bound(d, x);
    const Variation<Pack> I4 = variation_of_I4bar(b, fibre.I4);
    const Pack isochoric =
        0.5 * mu * variation_of_I1bar(b).curvature +
        value(value_eta_V) * (absolute(fibre.I4bar_1) * I4.curvature + I4.slope * I4.slope);
    replace_below_floor(d, b, isochoric, {value(value_K_V), mu}, result);
    return result;
  }

 private:
  // c = 2 (1+q) dW/dI4bar
  template <class Pack>
  [[gnu::always_inline]] static Pack tension(const Deformation<Pack>& d, const Fibre<Pack>& fibre,
                                             const BlockValues<Pack>& value) {
    return 2.0 * (1.0 + d.iso.q) * value(value_eta_V) * fibre.I4bar_1;
  }
};

}  // namespace trocar
