// A family of fibres along the unit vector a0 of the reference: I4bar = J^(-2/3) |F a0|^2.
#pragma once

#include "solver/deformation.h"
#include "solver/tangent_bound.h"

namespace trocar {

template <class Pack>
struct Fibre {
  Pack a0[3], a[3];  // a = F a0
  Pack I4;           // |a|^2
  Pack I4bar_1;      // I4bar - 1 = q + (1+q) a0 . 2E a0
};

// Its direction stands in the values at, at + 1, at + 2.
template <class Pack>
[[gnu::always_inline]] inline Fibre<Pack> fibre_of(const Deformation<Pack>& d,
                                                   const BlockValues<Pack>& value, int at) {
  Fibre<Pack> fibre;
  for (int i = 0; i < 3; ++i) fibre.a0[i] = value(at + i);
  const Pack(&a0)[3] = fibre.a0;
  Pack strain = zero_of(d.iso.q);
  for (int i = 0; i < 3; ++i) {
    fibre.a[i] = a0[i] + (d.H(i, 0) * a0[0] + d.H(i, 1) * a0[1] + d.H(i, 2) * a0[2]);
    for (int j = 0; j < 3; ++j) strain += a0[i] * d.twice_E.v[symmetric_index[i][j]] * a0[j];
  }
  fibre.I4 = 1.0 + strain;
  fibre.I4bar_1 = d.iso.q + (1.0 + d.iso.q) * strain;
  return fibre;
}

// dI4bar/dF = 2 J^(-2/3) (a (x) a0 - I4/3 F^-T), F^-T = inverse cof F. With the tension c = 2
// J^(-2/3) dW/dI4bar, the second term is a pressure and the first is added here.
template <class Pack>
[[gnu::always_inline]] inline Pack fibre_pressure(const Deformation<Pack>& d,
                                                  const Fibre<Pack>& fibre, const Pack& c) {
  return -c * fibre.I4 * d.iso.inverse * real<Pack>(1.0 / 3);
}
template <class Pack>
[[gnu::always_inline]] inline void add_fibre_stress(const Fibre<Pack>& fibre, const Pack& c,
                                                    Tensor<Pack>& P) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) P(i, j) += c * fibre.a[i] * fibre.a0[j];
}

// |a (x) a0 - I4/3 F^-T|^2 = I4/3 + I4^2/9 |F^-1|^2
template <class Pack>
[[gnu::always_inline]] inline Pack fibre_slope2(const Stretches<Pack>& x,
                                                const Fibre<Pack>& fibre) {
  Pack sum = zero_of(fibre.I4);
  for (int i = 0; i < 3; ++i) sum += x.inverse[i] * x.inverse[i];
  return fibre.I4 * real<Pack>(1.0 / 3) + fibre.I4 * fibre.I4 * sum * real<Pack>(1.0 / 9);
}

// The tension's part of the second variation, with e = (a (x) a0 - I4/3 F^-T) : dF:
//   c [ |dF a0|^2 - 4/3 a e - 2/9 I4 a^2 + I4/3 tr L^2 ],  2 |a e| <= |slope| (s a^2 + |dF|^2 / s),
// s = min s_i.
template <class Pack>
[[gnu::always_inline]] inline void add_fibre_terms(const Stretches<Pack>& x,
                                                   const Fibre<Pack>& fibre, const Pack& c,
                                                   const Pack& slope, TangentTerms<Pack>& terms) {
  const Pack cross = absolute(c) * slope * real<Pack>(2.0 / 3);
  terms.square += larger(zero_of(c), c) + cross * x.most_inverse;
  terms.volume += cross / x.most_inverse - c * fibre.I4 * real<Pack>(2.0 / 9);
  terms.trace_L2 += c * fibre.I4 * real<Pack>(1.0 / 3);
}

}  // namespace trocar
