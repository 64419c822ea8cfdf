// A rigorous bound of the tangent stiffness of decoupled materials in any deformation, for the
// stable step (stiffening.h). W_iso = sum_i w(x_i), x_i = log(s_i J^(-1/3)), with the stretches
// s_i; more terms are bounded one by one. With L = dF F^-1, a = tr L, z_i = L_ii in principal axes,
// t_i = w'(x_i) - mean and p = K J (J - 1), the second variation along dF has
//   a block of the dF_ii:  sum_i w''_i (dev z)_i^2 - sum (t_i + p) z_i^2 + K J (2J - 1) a^2
//                          <= sum (M - t_i - p) z_i^2 + [K J (2J - 1) - M/3] a^2,  M >= max w'',
//   and for each pair i, j the eigenvalues, with T = t + p (Hill 1970, Ball 1984),
//     (T_i/s_i + T_j/s_j) / (s_i + s_j) and
//     (T_i/s_i - T_j/s_j) / (s_i - s_j) <= [ M r - (T_i + T_j)/2 ] / (s_i s_j),
//   r = (s_i + s_j) / (2 sqrt(s_i s_j)) >= the ratio of arithmetic to logarithmic mean.
// So d2W <= alpha' a^2 + beta |dF|^2 and a^2 counts at most tr G / min s^2 in the element's bound.
#pragma once

#include "solver/deformation.h"
#include "solver/stiffening.h"
#include "solver/symmetric_eigenvalues.h"

namespace trocar {

template <class Pack>
struct Stretches {
  Pack s[3], inverse[3];  // s_i, 1 / s_i
  Pack square[3];         // lbar_i^2 = J^(-2/3) s_i^2
  Pack most_inverse;      // 1 / min s_i
  Pack most_square, least_square;
};

template <class Pack>
[[gnu::noinline]] void find_stretches(const Deformation<Pack>& d, Stretches<Pack>& stretches) {
  Pack strain[3];
  find_eigenvalues(d.twice_E, strain);
  Stretches<Pack>& x = stretches;
  const Pack tiny = zero_of(d.iso.q) + real<Pack>(1e-30);
  for (int i = 0; i < 3; ++i) {
    const Pack s2 = 1.0 + strain[i];
    x.s[i] = square_root(Pack(s2 < tiny ? tiny : s2));
    x.inverse[i] = 1.0 / x.s[i];
    x.square[i] = (1.0 + d.iso.q) * x.s[i] * x.s[i];
  }
  x.most_inverse = larger(larger(x.inverse[0], x.inverse[1]), x.inverse[2]);
  x.most_square = larger(larger(x.square[0], x.square[1]), x.square[2]);
  x.least_square = -larger(larger(Pack(-x.square[0]), Pack(-x.square[1])), Pack(-x.square[2]));
}

// What a material adds up before the bound is taken; all times the volume.
template <class Pack>
struct TangentTerms {
  Pack t[3];      // w'(x_i) - mean: isochoric Kirchhoff stress
  Pack M;         // >= w''(x_i), >= 0
  Pack diagonal;  // sum of c |dev g|^2 of further terms c (g . z)^2
  Pack trace_L2;  // coefficient of tr L^2
  Pack volume;    // coefficient of a^2
  Pack square;    // coefficient of |dF|^2
};

// A function f(I1bar): w = f' exp(2x), w' = 2 f' lbar^2, w'' = 4 f' lbar^2, and f'' (dI1bar)^2 with
// dI1bar = sum 2 (lbar_i^2 - mean) z_i.
template <class Pack>
[[gnu::always_inline]] inline TangentTerms<Pack> terms_of_I1bar(const Stretches<Pack>& x,
                                                                const Pack& df, const Pack& ddf) {
  const Pack zero = zero_of(df);
  const Pack mean = (x.square[0] + x.square[1] + x.square[2]) * real<Pack>(1.0 / 3);
  TangentTerms<Pack> terms{{zero, zero, zero}, zero, zero, zero, zero, zero};
  Pack g2 = zero;
  for (int i = 0; i < 3; ++i) {
    const Pack g = 2.0 * (x.square[i] - mean);
    terms.t[i] = df * g;
    g2 += g * g;
  }
  terms.M = larger(zero, Pack(4.0 * df * x.most_square));
  terms.diagonal = larger(zero, ddf) * g2;
  return terms;
}

// Growth of the bound of omega^2 against one with K - 2/3 mu and mu.
template <class Pack>
[[gnu::noinline]] void bound_tangent(const Deformation<Pack>& d, const Stretches<Pack>& x,
                                     const TangentTerms<Pack>& terms, const Pack& K, const Pack& mu,
                                     Pack& stiffening) {
  const Pack zero = zero_of(mu), J = 1.0 + d.change.j, p = K * J * d.change.j - terms.trace_L2;
  const Pack T[3] = {terms.t[0] + p, terms.t[1] + p, terms.t[2] + p};
  Pack beta = zero;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Pack inverse = x.inverse[i] * x.inverse[j], sum = x.s[i] + x.s[j];
    const Pack r = 0.5 * sum * square_root(inverse);
    beta = larger(beta, Pack((terms.M + terms.diagonal - T[i]) * x.inverse[i] * x.inverse[i]));
    beta = larger(beta, Pack((terms.M * r - 0.5 * (T[i] + T[j])) * inverse));
    beta = larger(beta, Pack((T[i] * x.inverse[i] + T[j] * x.inverse[j]) / sum));
  }
  const Pack alpha = K * J * (2.0 * J - 1.0) - terms.M * real<Pack>(1.0 / 3) + terms.volume;
  stiffening = stiffening_of(Pack(larger(zero, alpha) * x.most_inverse * x.most_inverse),
                             Pack(beta + terms.square), Pack(K - real<Pack>(2.0 / 3) * mu), mu);
}

}  // namespace trocar
