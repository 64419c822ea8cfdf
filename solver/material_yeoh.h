// Yeoh's material: W = c1 x + c2 x^2 + c3 x^3 + K/2 (J - 1)^2, x = I1bar - 3, mu = 2 c1.
#pragma once

#include "solver/deformation.h"
#include "solver/material_model.h"
#include "solver/tangent_bound_below_floor.h"

namespace trocar {

struct MaterialYeoh : Decoupled<MaterialYeoh> {
  static constexpr MaterialModel model = MaterialModel::yeoh;
  static constexpr int value_c2_V = 2, value_c3_V = 3;  // c1 = mu / 2
  static constexpr int n_values = 4;

  // P = F^-T [ 2 W1 (1+q) dev 2E + J pressure I ], W1 = dW/dI1bar
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    return stress_of_I1bar(d, Pack(2.0 * slope(d, value) * (1.0 + d.iso.q)), pressure);
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    const Pack x = d.I1bar_3;
    return x * (0.5 * value(value_mu_V) + x * (value(value_c2_V) + x * value(value_c3_V)));
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    const Pack ddW = 2.0 * value(value_c2_V) + 6.0 * value(value_c3_V) * d.I1bar_3;
    Stretches<Pack> x;
    find_stretches(d, x);
    Pack result;
    bound_tangent(d, x, terms_of_I1bar(x, slope(d, value), ddW), value(value_K_V),
                  value(value_mu_V), result);
    if (is_above_floor(d)) return result;
    const FloorBound<Pack> b = floor_bound(d, x);
    const Variation<Pack> I1 = variation_of_I1bar(b);
    const Pack isochoric =
        absolute(slope(d, value)) * I1.curvature + absolute(ddW) * I1.slope * I1.slope;
    replace_below_floor(d, b, isochoric, {value(value_K_V), value(value_mu_V)}, result);
    return result;
  }

 private:
  // W1 = c1 + 2 c2 x + 3 c3 x^2
  template <class Pack>
  [[gnu::always_inline]] static Pack slope(const Deformation<Pack>& d,
                                           const BlockValues<Pack>& value) {
    const Pack x = d.I1bar_3;
    return 0.5 * value(value_mu_V) + x * (2.0 * value(value_c2_V) + 3.0 * value(value_c3_V) * x);
  }
};

}  // namespace trocar
