// Holzapfel, Gasser and Ogden's material with dispersed fibres (Gasser, Ogden and Holzapfel 2006):
//   W = mu/2 (I1bar - 3) + sum over two families k1/(2 k2) (exp(k2 E^2) - 1) + K/2 (J - 1)^2,
//   E = kappa (I1bar - 3) + (1 - 3 kappa) (I4bar - 1), only where E > 0.
// Beyond k2 E^2 = 16, an exponential of nine million, the derivative dW/dE goes on linearly.
#pragma once

#include "solver/elementary.h"
#include "solver/fibre.h"
#include "solver/material_model.h"
#include "solver/tangent_bound_below_floor.h"

namespace trocar {

struct MaterialHolzapfelGasserOgden : Decoupled<MaterialHolzapfelGasserOgden> {
  static constexpr MaterialModel model = MaterialModel::holzapfel_gasser_ogden;
  static constexpr int value_k2 = 2, value_kappa = 3;
  static constexpr int value_most_E = 4;      // sqrt(16 / k2)
  static constexpr int value_half_by_k2 = 5;  // 1 / (2 k2)
  static constexpr int value_family = 6;      // of each: k1 V, a0
  static constexpr int n_families = 2;
  static constexpr int n_values = value_family + 4 * n_families;
  static constexpr double largest_exponent = 16;

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    const Pack power = 1.0 + d.iso.q, kappa = value(value_kappa);
    Pack shear = value(value_mu_V), total = pressure, c[n_families];
    Fibre<Pack> fibre[n_families];
    for (int k = 0; k < n_families; ++k) {
      fibre[k] = family(d, value, k);
      const Pack dW = response(d, fibre[k], value, k).dW;
      c[k] = 2.0 * power * (1.0 - 3.0 * kappa) * dW;
      shear += 2.0 * kappa * dW;
      total += fibre_pressure(d, fibre[k], c[k]);
    }
    Tensor<Pack> P = stress_of_I1bar(d, Pack(shear * power), total);
    for (int k = 0; k < n_families; ++k) add_fibre_stress(fibre[k], c[k], P);
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    Pack W = 0.5 * value(value_mu_V) * d.I1bar_3;
    for (int k = 0; k < n_families; ++k) W += response(d, family(d, value, k), value, k).W;
    return W;
  }

  // Beside the tensions' terms: W'' (dE)^2, |dE| <= 2 (1+q) [ kappa |F - I1/3 F^-T|
  // + (1 - 3 kappa) slope ] |dF|; W'' counts also where the fibres are slack, they may tighten.
  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    Pack result;
    find_stiffening(H, value, result);
    return result;
  }

 private:
  template <class Pack>
  struct Response {
    Pack W, dW, ddW;  // and its derivatives by E
  };

  template <class Pack>
  [[gnu::always_inline]] static Fibre<Pack> family(const Deformation<Pack>& d,
                                                   const BlockValues<Pack>& value, int k) {
    return fibre_of(d, value, value_family + 4 * k + 1);
  }

  // With y = min(E, most E) and z = E - y: dW = k1 exp(k2 y^2) (y + (1 + 2 k2 y^2) z).
  template <class Pack>
  [[gnu::always_inline]] static Response<Pack> response(const Deformation<Pack>& d,
                                                        const Fibre<Pack>& fibre,
                                                        const BlockValues<Pack>& value, int k) {
    const Pack kappa = value(value_kappa), most = value(value_most_E);
    const Pack k1 = value(value_family + 4 * k), zero = zero_of(k1);
    Pack E = kappa * d.I1bar_3 + (1.0 - 3.0 * kappa) * fibre.I4bar_1;
    E = E < 0.0 ? zero : E;
    const Pack y = E > most ? most : E, z = E - y;
    const Pack exponent = value(value_k2) * y * y, rise = expm1_of(exponent);
    const Pack slope = k1 * (1.0 + rise), ddW = slope * (1.0 + 2.0 * exponent);
    return {k1 * value(value_half_by_k2) * rise + z * (slope * y + 0.5 * z * ddW),
            slope * y + ddW * z, ddW};
  }

  template <class Pack>
  [[gnu::noinline]] static void find_stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value, Pack& result) {
    const Deformation<Pack> d = deformation_of(H);
    const Pack mu = value(value_mu_V), kappa = value(value_kappa), power = 1.0 + d.iso.q;
    Stretches<Pack> x;
    find_stretches(d, x);
    Response<Pack> r[n_families];
    Pack df = 0.5 * mu;
    for (int k = 0; k < n_families; ++k) {
      r[k] = response(d, family(d, value, k), value, k);
      df += kappa * r[k].dW;
    }
    TangentTerms<Pack> terms = terms_of_I1bar(x, df, zero_of(df));
    Pack g2 = zero_of(df);  // |F - I1/3 F^-T|^2
    const Pack third = (x.s[0] * x.s[0] + x.s[1] * x.s[1] + x.s[2] * x.s[2]) * real<Pack>(1.0 / 3);
    for (int i = 0; i < 3; ++i) {
      const Pack g = x.s[i] - third * x.inverse[i];
      g2 += g * g;
    }
    const FloorBound<Pack> b = floor_bound(d, x);
    const Variation<Pack> I1 = variation_of_I1bar(b);
    Pack below = 0.5 * mu * I1.curvature;
    for (int k = 0; k < n_families; ++k) {
      const Fibre<Pack> fibre = family(d, value, k);
      const Pack slope = square_root(fibre_slope2(x, fibre));
      const Pack share = 1.0 - 3.0 * kappa, dE = kappa * square_root(g2) + share * slope;
      add_fibre_terms(x, fibre, Pack(2.0 * power * share * r[k].dW), slope, terms);
      terms.square += 4.0 * power * power * r[k].ddW * dE * dE;
      const Variation<Pack> I4 = variation_of_I4bar(b, fibre.I4);
      const Pack dE_below = kappa * I1.slope + share * I4.slope;
      below +=
          r[k].dW * (kappa * I1.curvature + share * I4.curvature) + r[k].ddW * dE_below * dE_below;
    }
    bound_tangent(d, x, terms, value(value_K_V), mu, result);
    replace_below_floor(d, b, below, {value(value_K_V), mu}, result);
  }
};

}  // namespace trocar
