// What decoupled materials are made of: invariants of H = F - I without cancellation, and the four
// functions that their energy W(F) = W_iso(J^(-1/3) F) + K/2 (J - 1)^2 gives.
#pragma once

#include "solver/block_data.h"
#include "solver/isochoric.h"
#include "solver/tensor.h"

namespace trocar {

template <class Pack>
struct Deformation {
  Tensor<Pack> H;
  VolumeChange<Pack> change;
  Isochoric<Pack> iso;
  SymmetricTensor<Pack> twice_E;
  Pack I1bar_3;  // I1bar - 3 = 3 q + (1+q) tr 2E
};

template <class Pack>
[[gnu::always_inline]] inline Deformation<Pack> deformation_of(const Tensor<Pack>& H, const Pack& j,
                                                               const Isochoric<Pack>& iso) {
  Deformation<Pack> d;
  d.H = H;
  d.change = volume_and_area_change(H);
  d.change.j = j;
  d.iso = iso;
  d.twice_E = twice_green_strain(H);
  d.I1bar_3 = 3.0 * d.iso.q + (1.0 + d.iso.q) * trace(d.twice_E);
  return d;
}
template <class Pack>
[[gnu::always_inline]] inline Deformation<Pack> deformation_of(const Tensor<Pack>& H) {
  const Pack j = volume_change(H, cofactor(H));
  return deformation_of(H, j, isochoric(j));
}

// P = cof F [ shear inverse dev A + pressure I ] = F^-T [ shear dev A + J pressure I ], above the
// floor of isochoric.h all there is.
template <class Pack>
[[gnu::always_inline]] inline Tensor<Pack> stress_of(const Deformation<Pack>& d, const Pack& shear,
                                                     const SymmetricTensor<Pack>& A,
                                                     const Pack& pressure) {
  const Pack mean = trace(A) * real<Pack>(1.0 / 3), scale = shear * d.iso.inverse;
  SymmetricTensor<Pack> S;
  for (int i = 0; i < 3; ++i) S.v[i] = scale * (A.v[i] - mean) + pressure;
  for (int i = 3; i < 6; ++i) S.v[i] = scale * A.v[i];
  return product(d.change.cof_F, S);
}

// With y for 1/J an energy W(y^(2/3), C) has P = F S + d ln(1+q)/dJ W_ln cof F, S = 2 dW/dC: what
// stress_of gives with C S for shear A, and extended F S.
// F S = shear F: of an energy in I1bar.
template <class Pack>
[[gnu::always_inline]] inline Tensor<Pack> stress_of_I1bar(const Deformation<Pack>& d,
                                                           const Pack& shear,
                                                           const Pack& pressure) {
  Tensor<Pack> P = stress_of(d, shear, d.twice_E, pressure);
  const auto is_below = d.iso.extended > 0.0;
  if (!is_any(is_below)) return P;
  const Pack scale = shear * d.iso.extended;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Pack F = i == j ? Pack(1.0 + d.H(i, j)) : d.H(i, j);
      P(i, j) = is_below ? Pack(P(i, j) + scale * F) : P(i, j);
    }
  return P;
}
// Any other S.
template <class Pack>
[[gnu::always_inline]] inline void add_extended_stress(const Deformation<Pack>& d,
                                                       const SymmetricTensor<Pack>& S,
                                                       Tensor<Pack>& P) {
  const Tensor<Pack> HS = product(d.H, S);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) P(i, j) += d.iso.extended * (S.v[symmetric_index[i][j]] + HS(i, j));
}

// Material has stress_at(d, pressure, value): isochoric stress plus pressure cof F, and
// isochoric_energy_at(d, value).
template <class Material>
struct Decoupled {
  static constexpr bool is_decoupled = true;

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress(const Tensor<Pack>& H,
                                                    const BlockValues<Pack>& value) {
    return stress(deformation_of(H), value);
  }
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> stress(const Deformation<Pack>& d,
                                                    const BlockValues<Pack>& value) {
    return Material::stress_at(d, Pack(value(value_K_V) * d.change.j), value);
  }

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> isochoric_stress(const Tensor<Pack>& H,
                                                              const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    return Material::stress_at(d, zero_of(d.change.j), value);
  }

  // K j cof F
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> volumetric_stress(const Tensor<Pack>& H,
                                                               const BlockValues<Pack>& value) {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    Tensor<Pack> P = change.cof_F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) *= value(value_K_V) * change.j;
    return P;
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack energy(const Tensor<Pack>& H, const BlockValues<Pack>& value) {
    const Deformation<Pack> d = deformation_of(H);
    return Material::isochoric_energy_at(d, value) +
           0.5 * (value(value_K_V) * d.change.j * d.change.j);
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack isochoric_energy(const Tensor<Pack>& H,
                                                      const BlockValues<Pack>& value) {
    return Material::isochoric_energy_at(deformation_of(H), value);
  }
};

}  // namespace trocar
