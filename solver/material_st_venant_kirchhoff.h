// St. Venant-Kirchhoff material: W = lambda/2 (tr E)^2 + mu E : E with the Green strain E. Softens
// in compression: for moderate strain and large rotation.
#pragma once

#include "solver/block_data.h"
#include "solver/material_model.h"
#include "solver/stiffening.h"
#include "solver/symmetric_eigenvalues.h"

namespace trocar {

struct MaterialStVenantKirchhoff {
  static constexpr MaterialModel model = MaterialModel::st_venant_kirchhoff;
  static constexpr int n_values = 2;
  static constexpr bool is_decoupled = false;

  // P = F S,  S = lambda tr E I + 2 mu E
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress(const Tensor<Pack>& H,
                                                    const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V), lambda = value(value_K_V) - real<Pack>(2.0 / 3) * mu;
    SymmetricTensor<Pack> S = twice_green_strain(H);
    const Pack pressure = 0.5 * lambda * trace(S);
    for (int i = 0; i < 3; ++i) S.v[i] = mu * S.v[i] + pressure;
    for (int i = 3; i < 6; ++i) S.v[i] = mu * S.v[i];
    Tensor<Pack> P = product(H, S);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) += S.v[symmetric_index[i][j]];
    return P;
  }

  // For viscosity: the stress with K = 0, P = F 2 mu dev E, and the rest, P = F K tr E.
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> isochoric_stress(const Tensor<Pack>& H,
                                                              const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V);
    SymmetricTensor<Pack> S = twice_green_strain(H);
    const Pack mean = trace(S) * real<Pack>(1.0 / 3);
    for (int i = 0; i < 3; ++i) S.v[i] -= mean;
    for (Pack& s : S.v) s *= mu;
    Tensor<Pack> P = product(H, S);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) += S.v[symmetric_index[i][j]];
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> volumetric_stress(const Tensor<Pack>& H,
                                                               const BlockValues<Pack>& value) {
    const Pack pressure = 0.5 * value(value_K_V) * trace(twice_green_strain(H));
    Tensor<Pack> P = H;
    for (int i = 0; i < 3; ++i) {
      P(i, i) += 1.0;
      for (int j = 0; j < 3; ++j) P(i, j) *= pressure;
    }
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack energy(const Tensor<Pack>& H, const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V), lambda = value(value_K_V) - real<Pack>(2.0 / 3) * mu;
    const SymmetricTensor<Pack> S = twice_green_strain(H);
    const auto& s = S.v;
    const Pack square =
        s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    return 0.125 * lambda * trace(S) * trace(S) + 0.25 * mu * square;
  }

  // d2W = dF S : dF + lambda (F:dF)^2 + 2 mu |sym F^T dF|^2
  //     <= lambda (F:dF)^2 + (max(0, lambda_max(S)) + 2 mu s^2) |dF|^2,  s^2 = lambda_max(C),
  // and (F:dF)^2 counts at most s^2 tr G in the element's bound.
  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V), lambda = value(value_K_V) - real<Pack>(2.0 / 3) * mu;
    const SymmetricTensor<Pack> twice_E = twice_green_strain(H);
    const Pack e = largest_eigenvalue(twice_E), zero = e - e, s2 = 1.0 + e;
    const Pack stress = larger(zero, Pack(0.5 * lambda * trace(twice_E) + mu * e));
    return stiffening_of(Pack(larger(zero, lambda) * s2), Pack(stress + 2.0 * mu * s2), lambda, mu);
  }
};

}  // namespace trocar
