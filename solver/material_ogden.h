// Ogden's material with up to three terms,
//   W = sum_p 2 mu_p / alpha_p^2 (lbar_1^alpha_p + lbar_2^alpha_p + lbar_3^alpha_p - 3)
//       + K/2 (J - 1)^2,
// so that mu = sum mu_p (the other convention has mu_p / alpha_p in front).
#pragma once

#include "solver/deformation.h"
#include "solver/elementary.h"
#include "solver/material_model.h"
#include "solver/tangent_bound.h"

namespace trocar {

struct MaterialOgden : Decoupled<MaterialOgden> {
  static constexpr MaterialModel model = MaterialModel::ogden;
  static constexpr int n_terms = 3;
  static constexpr int value_mu_p_V = 2, value_alpha = 5, value_inverse_alpha = 8;
  static constexpr int n_values = 11;

  // P = F^-T [ sum_i dev b_i N_i (x) N_i + J pressure I ],
  // b_i = sum_p 2 mu_p / alpha_p expm1(alpha_p log lbar_i)
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress_at(const Deformation<Pack>& d,
                                                       const Pack& pressure,
                                                       const BlockValues<Pack>& value) {
    SymmetricTensor<Pack> A;
    find_stress(d.twice_E, value, A);
    return stress_of(d, Pack(zero_of(pressure) + 1.0), A, pressure);
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    SymmetricEigen<Pack> eigen;
    find_eigen(d.twice_E, eigen);
    Pack x[3], W = zero_of(d.iso.q);
    log_stretches(eigen, x);
    for (int p = 0; p < n_terms; ++p) {
      const Pack alpha = value(value_alpha + p), inverse = value(value_inverse_alpha + p);
      const Pack scale = 2.0 * value(value_mu_p_V + p) * inverse * inverse;
      for (const Pack& xi : x) W += scale * expm1_of(Pack(alpha * xi));
    }
    return W;
  }

  // w' = sum_p 2 mu_p / alpha_p exp(alpha_p x), w'' = sum_p 2 mu_p exp(alpha_p x)
  template <class Pack>
  [[gnu::always_inline]] static Pack stiffening(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    Stretches<Pack> s;
    find_stretches(d, s);
    TangentTerms<Pack> terms{};
    find_terms(s, value, terms);
    Pack result;
    bound_tangent(d, s, terms, value(value_K_V), value(value_mu_V), result);
    return result;
  }

 private:
  // Without the volume's share, so that their sum vanishes.
  template <class Pack>
  [[gnu::always_inline]] static void log_stretches(const SymmetricEigen<Pack>& eigen,
                                                   Pack (&x)[3]) {
    for (int i = 0; i < 3; ++i) x[i] = 0.5 * log1p_of(eigen.value[i]);
    remove_mean(x);
  }

  template <class Pack>
  [[gnu::always_inline]] static void remove_mean(Pack (&x)[3]) {
    const Pack mean = (x[0] + x[1] + x[2]) * real<Pack>(1.0 / 3);
    for (Pack& xi : x) xi -= mean;
  }

  template <class Pack>
  [[gnu::noinline]] static void find_stress(const SymmetricTensor<Pack>& twice_E,
                                            const BlockValues<Pack>& value,
                                            SymmetricTensor<Pack>& A) {
    SymmetricEigen<Pack> eigen;
    find_eigen(twice_E, eigen);
    Pack x[3], b[3];
    log_stretches(eigen, x);
    for (int i = 0; i < 3; ++i) b[i] = zero_of(x[i]);
#pragma GCC unroll 1
    for (int p = 0; p < n_terms; ++p) {
      const Pack alpha = value(value_alpha + p);
      const Pack scale = 2.0 * value(value_mu_p_V + p) * value(value_inverse_alpha + p);
      for (int i = 0; i < 3; ++i) b[i] += scale * expm1_of(Pack(alpha * x[i]));
    }
    remove_mean(b);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        Pack& a = A.v[symmetric_index[i][j]];
        a = zero_of(x[0]);
        for (int k = 0; k < 3; ++k) a += b[k] * eigen.vector[k][i] * eigen.vector[k][j];
      }
  }

  template <class Pack>
  [[gnu::noinline]] static void find_terms(const Stretches<Pack>& s, const BlockValues<Pack>& value,
                                           TangentTerms<Pack>& terms) {
    const Pack zero = zero_of(s.s[0]);
    terms = {{zero, zero, zero}, zero, zero, zero, zero, zero};
    Pack x[3], ddw[3] = {zero, zero, zero};
    for (int i = 0; i < 3; ++i) x[i] = log1p_of(Pack(s.s[i] - 1.0));
    remove_mean(x);
#pragma GCC unroll 1
    for (int p = 0; p < n_terms; ++p) {
      const Pack alpha = value(value_alpha + p), mu = value(value_mu_p_V + p);
      for (int i = 0; i < 3; ++i) {
        const Pack power = 1.0 + expm1_of(Pack(alpha * x[i]));
        terms.t[i] += 2.0 * mu * value(value_inverse_alpha + p) * power;
        ddw[i] += 2.0 * mu * power;
      }
    }
    remove_mean(terms.t);
    terms.M = larger(larger(ddw[0], ddw[1]), ddw[2]);  // w'' is convex
  }
};

}  // namespace trocar
