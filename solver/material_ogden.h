// Ogden's material with up to three terms,
//   W = sum_p 2 mu_p / alpha_p^2 (lbar_1^alpha_p + lbar_2^alpha_p + lbar_3^alpha_p - 3)
//       + K/2 (J - 1)^2,
// so that mu = sum mu_p (the other convention has mu_p / alpha_p in front).
#pragma once

#include "solver/deformation.h"
#include "solver/elementary.h"
#include "solver/material_model.h"
#include "solver/symmetric_eigen.h"
#include "solver/tangent_bound_below_floor.h"

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
    SymmetricTensor<Pack> A, S;
    find_stress(d, value, A, S);
    Tensor<Pack> P = stress_of(d, Pack(zero_of(pressure) + 1.0), A, pressure);
    add_extended_stress(d, S, P);
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy_at(const Deformation<Pack>& d,
                                                         const BlockValues<Pack>& value) {
    SymmetricEigen<Pack> eigen;
    find_eigen(d.twice_E, eigen);
    Pack W = zero_of(d.iso.q);
    const LogStretches<Pack> log = log_stretches(d, eigen);
    for (int p = 0; p < n_terms; ++p) {
      const Pack inverse = value(value_inverse_alpha + p);
      const Pack scale = 2.0 * value(value_mu_p_V + p) * inverse * inverse;
      for (int i = 0; i < 3; ++i) W += scale * expm1_of(log.exponent(i, value(value_alpha + p)));
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
    if (is_above_floor(d)) return result;
    const FloorBound<Pack> b = floor_bound(d, s);
    Pack isochoric;
    find_curvature(b, value, isochoric);
    replace_below_floor(d, b, isochoric, {value(value_K_V), value(value_mu_V)}, result);
    return result;
  }

 private:
  // x_i = log lbar_i, and x_1 + x_2 + x_3, which is 0 above the floor of isochoric.h. Below it a
  // term with alpha < 0 is taken as the power -alpha of the products lbar_j lbar_k: alike above,
  // and without a pole at J = 0.
  template <class Pack>
  struct LogStretches {
    Pack x[3], sum;

    [[gnu::always_inline]] Pack exponent(int i, const Pack& alpha) const {
      return alpha * x[i] + (alpha < 0.0 ? Pack(-alpha * sum) : zero_of(alpha));
    }
  };

  template <class Pack>
  [[gnu::always_inline]] static LogStretches<Pack> log_stretches(
      const Deformation<Pack>& d, const SymmetricEigen<Pack>& eigen) {
    LogStretches<Pack> log;
    Pack(&x)[3] = log.x;
    for (int i = 0; i < 3; ++i) x[i] = 0.5 * log1p_of(eigen.value[i]);
    const Pack sum = x[0] + x[1] + x[2], volume = -1.5 * log1p_of(d.iso.q);
    const auto is_below = d.iso.extended > 0.0;
    const Pack mean = (is_below ? volume : sum) * real<Pack>(1.0 / 3);
    for (Pack& xi : x) xi -= mean;
    log.sum = is_below ? Pack(sum - volume) : zero_of(sum);
    return log;
  }

  template <class Pack>
  [[gnu::always_inline]] static void remove_mean(Pack (&x)[3]) {
    const Pack mean = (x[0] + x[1] + x[2]) * real<Pack>(1.0 / 3);
    for (Pack& xi : x) xi -= mean;
  }

  // b_i of A, and S = 2 dW/dC in the same axes: S_i = dW/d(log s_i) / s_i^2, where a term with
  // alpha > 0 has dW/d(log s_i) = 2 mu / alpha e_i, e = exp(exponent), and one with alpha < 0
  // -2 mu / alpha (e_j + e_k).
  template <class Pack>
  [[gnu::noinline]] static void find_stress(const Deformation<Pack>& d,
                                            const BlockValues<Pack>& value,
                                            SymmetricTensor<Pack>& A, SymmetricTensor<Pack>& S) {
    SymmetricEigen<Pack> eigen;
    find_eigen(d.twice_E, eigen);
    Pack b[3], g[3];
    const LogStretches<Pack> log = log_stretches(d, eigen);
    for (int i = 0; i < 3; ++i) b[i] = g[i] = zero_of(log.sum);
#pragma GCC unroll 1
    for (int p = 0; p < n_terms; ++p) {
      const Pack alpha = value(value_alpha + p);
      const Pack scale = 2.0 * value(value_mu_p_V + p) * value(value_inverse_alpha + p);
      Pack h[3];
      for (int i = 0; i < 3; ++i) {
        h[i] = expm1_of(log.exponent(i, alpha));
        b[i] += scale * h[i];
      }
      for (int i = 0; i < 3; ++i)
        g[i] += scale * (alpha < 0.0 ? Pack(-2.0 - h[(i + 1) % 3] - h[(i + 2) % 3]) : 1.0 + h[i]);
    }
    remove_mean(b);
    constexpr auto tiny = real<Pack>(sizeof(RealOf<Pack>) == 8 ? 1e-16 : 1e-7);
    for (int i = 0; i < 3; ++i) {
      const Pack s2 = 1.0 + eigen.value[i];
      g[i] /= s2 < tiny ? zero_of(s2) + tiny : s2;
      g[i] = d.iso.extended > 0.0 ? g[i] : zero_of(s2);  // no 0 times infinity
    }
    assemble(eigen, b, A);
    assemble(eigen, g, S);
  }

  template <class Pack>
  [[gnu::always_inline]] static void assemble(const SymmetricEigen<Pack>& eigen, const Pack (&b)[3],
                                              SymmetricTensor<Pack>& A) {
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        Pack& a = A.v[symmetric_index[i][j]];
        a = zero_of(b[0]);
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

  // Of G = sum of n-th powers of the stretches (n = alpha) or of those of areas (n = -alpha), with
  // m the one that makes the power largest, D and D2 as in variation_of_I2bar:
  //   |dG| <= sqrt(3) n m^(n-1) D,  |d2G| <= n max(1, n-1) m^(n-2) D^2 + sqrt(3) n m^(n-1) D2.
  template <class Pack>
  [[gnu::noinline]] static void find_curvature(const FloorBound<Pack>& b,
                                               const BlockValues<Pack>& value, Pack& sum) {
    sum = zero_of(b.area);
    constexpr auto root = real<Pack>(1.7320508075688773);
#pragma GCC unroll 1
    for (int p = 0; p < n_terms; ++p) {
      const Pack alpha = value(value_alpha + p), inverse = value(value_inverse_alpha + p);
      const Pack n = absolute(alpha), one = zero_of(n) + 1.0;
      const auto is_area = alpha < 0.0;
      const Pack D = is_area ? Pack(2.0 * b.most_stretch) : one;
      const Pack D2 = is_area ? one * real<Pack>(2 / 1.7320508075688773) : zero_of(n);
      const Pack high = log1p_of(Pack((is_area ? b.most_area : b.most_stretch) - 1.0));
      const Pack low = log1p_of(Pack((is_area ? b.least_area : b.least_stretch) - 1.0));
      const auto power = [&](const Pack& m) __attribute__((always_inline)) {
        return 1.0 + expm1_of(larger(Pack(m * high), Pack(m * low)));
      };
      const Pack first = root * n * power(n - 1.0);
      const Pack second = n * larger(one, n - 1.0) * power(n - 2.0) * D * D;
      const Variation<Pack> G = {3.0 * power(n), first * D, second + first * D2};
      sum += 2.0 * value(value_mu_p_V + p) * inverse * inverse *
             times_power_of_y(b, is_area ? n : 0.5 * n, G).curvature;
    }
  }
};

}  // namespace trocar
