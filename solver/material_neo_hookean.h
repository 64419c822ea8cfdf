// Decoupled neo-Hookean material: W = mu/2 (I1bar - 3) + K/2 (J - 1)^2, I1bar = J^(-2/3) tr C,
// K = lambda + 2/3 mu, in the form that has no cancellation at small strain.
#pragma once

#include "solver/deformation.h"
#include "solver/material_model.h"
#include "solver/tangent_bound_below_floor.h"
#include "solver/tangent_excess.h"

namespace trocar {

struct MaterialNeoHookean : Decoupled<MaterialNeoHookean> {
  static constexpr MaterialModel model = MaterialModel::neo_hookean;
  static constexpr int n_values = 2;

  // With a = mu (1+q) and F^-T = cof F / J,
  //   P = F^-T [ a dev 2E + J pressure I ] = a F + c cof F = m I + a H + c (cof F - I),
  //   c = m - a,  m = pressure + a (j - tr 2E / 3) / J.
  // In 144 operations in place of 200, but a and c cancel where the body has turned: in single
  // precision what is left of mu would be a moment that turns a free body by 7e-6 in 1e5 steps. The
  // first form has none: its rounding is that of a symmetric tensor.
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    if constexpr (sizeof(RealOf<Pack>) == sizeof(float))
      return stress_of_I1bar(d, Pack(value(value_mu_V) * (1.0 + d.iso.q)), pressure);
    const Tensor<Pack>& H = d.H;
    const Tensor<Pack> cof_H = cofactor(H);
    Pack square = H(0, 0) * H(0, 0);
    for (int k = 1; k < 9; ++k) square += H(k / 3, k % 3) * H(k / 3, k % 3);
    const Pack tr_2E = 2.0 * trace(H) + square;
    const Pack a = value(value_mu_V) * (1.0 + d.iso.q);
    const Pack m = pressure + a * (d.iso.inverse * (d.change.j - real<Pack>(1.0 / 3) * tr_2E) +
                                   d.iso.extended);
    const Pack c = m - a, diagonal = m + c * trace(H);
    Tensor<Pack> P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        P(i, j) = a * H(i, j) + c * (cof_H(i, j) - H(j, i));
        if (i == j) P(i, j) += diagonal;
      }
    return P;
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
    if (is_above_floor(d)) return result;
    const FloorBound<Pack> b = floor_bound(d, x);
    replace_below_floor(d, b, Pack(0.5 * mu * variation_of_I1bar(b).curvature),
                        {value(value_K_V), mu}, result);
    return result;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack excess(const Tensor<Pack>& H, const BlockValues<Pack>& value,
                                            const Pack& limit) {
    return excess_of_I1bar(H, value(value_K_V), value(value_mu_V), limit);
  }
};

}  // namespace trocar
