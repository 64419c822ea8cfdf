// Decoupled neo-Hookean material: W = mu/2 (I1bar - 3) + K/2 (J - 1)^2, I1bar = J^(-2/3) tr C,
// K = lambda + 2/3 mu, in the form that has no cancellation at small strain (numerics 1.4).
#pragma once

#include "solver/deformation.h"
#include "solver/material_model.h"
#include "solver/tangent_bound_below_floor.h"

namespace trocar {

struct MaterialNeoHookean : Decoupled<MaterialNeoHookean> {
  static constexpr MaterialModel model = MaterialModel::neo_hookean;
  static constexpr int n_values = 2;

  // P = F^-T [ mu (1+q) dev 2E + J pressure I ]
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    return stress_of_I1bar(d, Pack(value(value_mu_V) * (1.0 + d.iso.q)), pressure);
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    return 0.5 * value(value_mu_V) * d.I1bar_3;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    const Pack mu = value(value_mu_V);
    Stretches<Pack> x;
    find_stretches(d, x);
    Pack result;
    bound_tangent(d, x, terms_of_I1bar(x, Pack(0.5 * mu), zero_of(mu)), value(value_K_V), mu,
                  result);
    const FloorBound<Pack> b = floor_bound(d, x);
    replace_below_floor(d, b, Pack(0.5 * mu * variation_of_I1bar(b).curvature),
                        {value(value_K_V), mu}, result);
    return result;
  }
};

}  // namespace trocar
