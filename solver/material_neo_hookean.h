// Decoupled neo-Hookean material: W = mu/2 (I1bar - 3) + K/2 (J - 1)^2, I1bar = J^(-2/3) tr C,
// K = lambda + 2/3 mu, in the form that has no cancellation at small strain (numerics 1.4).
#pragma once

#include "solver/block_data.h"
#include "solver/isochoric.h"
#include "solver/largest_eigenvalue.h"
#include "solver/material.h"
#include "solver/stiffening.h"

namespace trocar {

struct MaterialNeoHookean {
  static constexpr MaterialModel model = MaterialModel::neo_hookean;
  static constexpr int n_values = 2;
  static constexpr bool is_decoupled = true;

  // First Piola-Kirchhoff stress. With q = J^(-2/3) - 1, j = J - 1:
  //   P = F^-T [ mu (1+q) dev 2E + K J j I ] = cof F [ mu (1+q)/J dev 2E + K j I ]
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress(const Tensor<Pack>& H,
                                                    const BlockValues<Pack>& value) {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    return stress_at(H, change, Pack(value(value_K_V) * change.j), value);
  }

  // The part of W's isochoric term.
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> isochoric_stress(const Tensor<Pack>& H,
                                                              const BlockValues<Pack>& value) {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    return stress_at(H, change, zero_of(change.j), value);
  }

  // W = mu/2 (3 q + (1+q) tr 2E) + K/2 j^2
  template <class Pack>
  [[gnu::always_inline]] static Pack energy(const Tensor<Pack>& H, const BlockValues<Pack>& value) {
    const Pack j = volume_change(H, cofactor(H));
    return isochoric_energy(H, value) + 0.5 * (value(value_K_V) * j * j);
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy(const Tensor<Pack>& H,
                                                      const BlockValues<Pack>& value) {
    const Pack q = isochoric(volume_change(H, cofactor(H))).q;
    return 0.5 * value(value_mu_V) * (3.0 * q + (1.0 + q) * trace(twice_green_strain(H)));
  }

  // Factor by which the bound of omega^2 (element_setup.h) grows in the present deformation. With
  // a = F^-T : dF, singular values s_i of F, m = mu J^(-2/3), I1 = tr C, and the deviatoric part
  // of F : dF, which is at most |v| |dF| with |v|^2 = sum (s_i - I1/(3 s_i))^2:
  //   d2W = [K J (2J-1) - 2/9 m I1] a^2 - 4/3 m a (dev FF^T : dF F^-1) + m |dF|^2
  //         + [m I1/3 - K J (J-1)] tr (F^-1 dF)^2  <=  alpha a^2 + beta |dF|^2,
  //   alpha = K J (2J-1) - 2/9 m I1 + 2/3 m |v| s_min,
  //   beta  = m + |m I1/3 - K J (J-1)| / s_min^2 + 2/3 m |v| / s_min,
  // so omega^2 <= (n/rho) (alpha / s_min^2 tr G + beta lambda_max(G)), 1/s_min = sigma_max(cof
  // F)/J.
  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Pack mu = value(value_mu_V), K = value(value_K_V);
    const Pack j = volume_change(H, cofactor(H)), J = 1.0 + j;
    const Isochoric<Pack> iso = isochoric(j);
    SymmetricTensor<Pack> C = twice_green_strain(H);
    for (int i = 0; i < 3; ++i) C.v[i] += 1.0;
    const SymmetricTensor<Pack> cof_C = cofactor(C);
    const Pack inverse_J2 = iso.inverse_J * iso.inverse_J, I1 = trace(C);
    const Pack inverse_s2 = largest_eigenvalue(cof_C) * inverse_J2;
    const Pack zero = j - j;
    const Pack v2 =
        larger(zero, Pack(I1 * (I1 * trace(cof_C) * inverse_J2 * real<Pack>(1.0 / 9) - 1.0)));
    const Pack inverse_s = square_root(inverse_s2), v = square_root(v2);
    const Pack m = mu * (1.0 + iso.q);
    const Pack alpha = (K * J * (2.0 * J - 1.0) - m * I1 * real<Pack>(2.0 / 9)) * inverse_s2 +
                       m * v * inverse_s * real<Pack>(2.0 / 3);
    const Pack beta = m + absolute(Pack(m * I1 * real<Pack>(1.0 / 3) - K * J * j)) * inverse_s2 +
                      m * v * inverse_s * real<Pack>(2.0 / 3);
    return stiffening_of(larger(zero, alpha), beta, Pack(K - real<Pack>(2.0 / 3) * mu), mu);
  }

 private:
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Tensor<Pack>& H,
                                                       const VolumeChange<Pack>& change,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    const Isochoric<Pack> iso = isochoric(change.j);
    SymmetricTensor<Pack> S = twice_green_strain(H);
    const Pack mean = trace(S) * real<Pack>(1.0 / 3);
    const Pack shear = value(value_mu_V) * (1.0 + iso.q) * iso.inverse_J;
    for (int i = 0; i < 3; ++i) S.v[i] = shear * (S.v[i] - mean) + pressure;
    for (int i = 3; i < 6; ++i) S.v[i] = shear * S.v[i];
    return product(change.cof_F, S);
  }
};

}  // namespace trocar
