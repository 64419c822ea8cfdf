// Prony viscoelasticity of the isochoric stress (Simo 1987): branches with history h_b,
//   S = S_vol + (1 - sum g_b) S_iso + sum_b h_b,
//   h_b+ = exp(-x) h_b + g_b (1 - exp(-x)) / x (S_iso+ - S_iso),  x = dt / tau_b
// (viscous_history.h). S_iso is the second Piola-Kirchhoff stress of the elastic law (times the
// volume), so that rotations do nothing; the linear law's is its P.
#pragma once

#include "solver/block_data.h"
#include "solver/material_model.h"
#include "solver/viscous_history.h"

namespace trocar {

// The law with its history, [point][number][lane] from the group's first lane on. Each call of a
// stress takes the next point and brings its history to the present; where it stands there already
// (no time has passed and S_iso is the same), nothing changes. A trial stress is what the stress of
// that point would be, and leaves the history alone.
template <class MaterialType, class Pack>
struct ViscousLaw {
  using Material = MaterialType;
  BlockValues<Pack> value;
  const ViscousStep& step;
  mutable double* history;

  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    return with_volumetric_stress(H, isochoric_stress(H));
  }

  [[gnu::always_inline]] Tensor<Pack> trial_stress(const Tensor<Pack>& H) const {
    Tensor<Pack> P = Material::isochoric_stress(H, value);
    add_viscous_stress<HistoryCall::trial>(H, P);
    return with_volumetric_stress(H, P);
  }

  [[gnu::always_inline]] Tensor<Pack> stress_at_pressure(const Tensor<Pack>& H,
                                                         const Pack& pressure) const {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    Tensor<Pack> P = isochoric_stress(H);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) += pressure * change.cof_F(i, j);
    return P;
  }

  [[gnu::always_inline]] Tensor<Pack> isochoric_stress(const Tensor<Pack>& H) const {
    Tensor<Pack> P = Material::isochoric_stress(H, value);
    add_viscous_stress<HistoryCall::moves_history>(H, P);
    return P;
  }

 private:
  static constexpr int lanes = block_lanes<Pack>;
  static constexpr bool is_small_strain = Material::model == MaterialModel::linear;

  [[gnu::always_inline]] Tensor<Pack> with_volumetric_stress(const Tensor<Pack>& H,
                                                             Tensor<Pack> P) const {
    const Tensor<Pack> volumetric = Material::volumetric_stress(H, value);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) += volumetric(i, j);
    return P;
  }

  // P += F (sum h - sum g S_iso), S_iso = F^-1 P = (cof F)^T P / J.
  template <HistoryCall call>
  [[gnu::noinline]] void add_viscous_stress(const Tensor<Pack>& H, Tensor<Pack>& P) const {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    const Pack inverse_J = finite_inverse_J(change.j);
    SymmetricTensor<Pack> S;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        Pack& s = S.v[symmetric_index[i][j]];
        if constexpr (is_small_strain) {
          s = P(i, j);
        } else {
          const Tensor<Pack>& A = change.cof_F;
          s = (A(0, i) * P(0, j) + A(1, i) * P(1, j) + A(2, i) * P(2, j)) * inverse_J;
        }
      }
    for (int c = 0; c < 6; ++c) S.v[c] = advance_history<call>(step, 6, c, S.v[c], history);
    if constexpr (call == HistoryCall::moves_history)
      history += history_of_point(step.n_branches) * lanes;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        P(i, j) += S.v[symmetric_index[i][j]];
        if constexpr (!is_small_strain)
          for (int k = 0; k < 3; ++k) P(i, j) += H(i, k) * S.v[symmetric_index[k][j]];
      }
  }
};

}  // namespace trocar
