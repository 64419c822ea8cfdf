// Mooney-Rivlin material: W = c10 (I1bar - 3) + c01 (I2bar - 3) + K/2 (J - 1)^2,
// mu = 2 (c10 + c01).
#pragma once

#include "solver/deformation.h"
#include "solver/material_model.h"
#include "solver/tangent_bound_below_floor.h"

namespace trocar {

struct MaterialMooneyRivlin : Decoupled<MaterialMooneyRivlin> {
  static constexpr MaterialModel model = MaterialModel::mooney_rivlin;
  static constexpr int value_c10_V = 2, value_c01_V = 3;
  static constexpr int n_values = 4;

  // P = F^-T { (1+q) dev[ (2 c10 + 2 c01 (I1bar - 2 (1+q))) 2E - 2 c01 (1+q) (2E)^2 ]
  //            + J pressure I }
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    const Pack c01 = value(value_c01_V), power = 1.0 + d.iso.q;
    const Pack first = 2.0 * (value(value_c10_V) + c01 * (d.I1bar_3 + 1.0 - 2.0 * d.iso.q));
    const Pack second = 2.0 * c01 * power;
    SymmetricTensor<Pack> A = square(d.twice_E), S;
    for (int i = 0; i < 6; ++i) {
      A.v[i] = first * d.twice_E.v[i] - second * A.v[i];
      S.v[i] = power * ((i < 3 ? first + second : zero_of(first)) - second * d.twice_E.v[i]);
    }
    Tensor<Pack> P = stress_of(d, power, A, pressure);
    add_extended_stress(d, S, P);
    return P;
  }

  // I2bar - 3 = 3 q4 + (1+q4) (2 tr 2E + ((tr 2E)^2 - tr (2E)^2)/2), 1 + q4 = (1+q)^2
  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    const Pack q4 = d.iso.q * (2.0 + d.iso.q), first = trace(d.twice_E);
    const Pack minors = trace(cofactor(d.twice_E));
    const Pack I2bar_3 = 3.0 * q4 + (1.0 + q4) * (2.0 * first + minors);
    return value(value_c10_V) * d.I1bar_3 + value(value_c01_V) * I2bar_3;
  }

  // w = c10 exp(2x) + c01 exp(-2x)
  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    const Pack c10 = value(value_c10_V), c01 = value(value_c01_V), zero = zero_of(c10);
    Stretches<Pack> x;
    find_stretches(d, x);
    TangentTerms<Pack> terms = terms_of_I1bar(x, c10, zero);
    const Pack inverse[3] = {1.0 / x.square[0], 1.0 / x.square[1], 1.0 / x.square[2]};
    const Pack mean = (inverse[0] + inverse[1] + inverse[2]) * real<Pack>(1.0 / 3);
    for (int i = 0; i < 3; ++i) terms.t[i] -= 2.0 * c01 * (inverse[i] - mean);
    terms.M += larger(zero, Pack(4.0 * c01 / x.least_square));
    Pack result;
    bound_tangent(d, x, terms, value(value_K_V), value(value_mu_V), result);
    if (is_above_floor(d)) return result;
    const FloorBound<Pack> b = floor_bound(d, x);
    const Pack isochoric = absolute(c10) * variation_of_I1bar(b).curvature +
                           absolute(c01) * variation_of_I2bar(b).curvature;
    replace_below_floor(d, b, isochoric, {value(value_K_V), value(value_mu_V)}, result);
    return result;
  }
};

}  // namespace trocar
