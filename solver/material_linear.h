// Linear elasticity at small strain: P = lambda tr H I + mu (H + H^T). Rotations make strain: for
// small displacements and for comparison with the paper's K U.
#pragma once

#include "solver/block_data.h"
#include "solver/material_model.h"
#include "solver/tensor.h"

namespace trocar {

struct MaterialLinear {
  static constexpr MaterialModel model = MaterialModel::linear;

  static constexpr int n_values = 2;
  static constexpr bool is_decoupled = false;

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress(const Tensor<Pack>& H,
                                                    const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V), lambda = value(value_K_V) - real<Pack>(2.0 / 3) * mu;
    const Pack pressure = lambda * trace(H);
    Tensor<Pack> P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        P(i, j) = mu * (H(i, j) + H(j, i));
        if (i == j) P(i, j) += pressure;
      }
    return P;
  }

  // For viscosity: the stress with K = 0, and the rest.
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> isochoric_stress(const Tensor<Pack>& H,
                                                              const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V), mean = trace(H) * real<Pack>(1.0 / 3);
    Tensor<Pack> P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        P(i, j) = mu * (H(i, j) + H(j, i));
        if (i == j) P(i, j) = 2.0 * mu * (H(i, i) - mean);
      }
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> volumetric_stress(const Tensor<Pack>& H,
                                                               const BlockValues<Pack>& value) {
    Tensor<Pack> P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P(i, j) = i == j ? Pack(value(value_K_V) * trace(H)) : zero_of(H(0, 0));
    return P;
  }

  // W = P : H / 2
  template <class Pack>
  [[gnu::always_inline]] static Pack energy(const Tensor<Pack>& H, const BlockValues<Pack>& value) {
    const Tensor<Pack> P = stress(H, value);
    Pack sum = P(0, 0) * H(0, 0);
    for (int i = 0; i < 3; ++i)
      for (int j = i == 0 ? 1 : 0; j < 3; ++j) sum += P(i, j) * H(i, j);
    return 0.5 * sum;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H, const BlockValues<Pack>&) {
    return zero_of(H(0, 0)) + 1.0;
  }
};

}  // namespace trocar
