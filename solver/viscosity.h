// Prony viscoelasticity of the isochoric stress (Simo 1987; numerics 1.8): branches with history
// h_b,
//   S = S_vol + (1 - sum g_b) S_iso + sum_b h_b,
//   h_b+ = exp(-x) h_b + g_b (1 - exp(-x)) / x (S_iso+ - S_iso),  x = dt / tau_b,
// second order and stable for any dt. S_iso is the second Piola-Kirchhoff stress of the elastic law
// (times the volume), so that rotations do nothing; the linear law's is its P. The history is in
// double always: single would stop relaxing at tau / dt ~ 1e6.
#pragma once

#include "solver/block_data.h"
#include "solver/in_double.h"
#include "solver/isochoric.h"
#include "solver/material_model.h"
#include "solver/viscous_step.h"

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
    add_viscous_stress<Call::trial>(H, P);
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
    add_viscous_stress<Call::moves_history>(H, P);
    return P;
  }

 private:
  enum class Call { moves_history, trial };
  static constexpr int width = pack_width<Pack>;
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
  template <Call call>
  [[gnu::noinline]] void add_viscous_stress(const Tensor<Pack>& H, Tensor<Pack>& P) const {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    // Below the floor of isochoric.h its factor for 1/J keeps the history finite through J = 0.
    const Isochoric<Pack> iso = isochoric(change.j);
    const Pack inverse_J = iso.extended > 0.0 ? iso.inverse : 1.0 / (1.0 + change.j);
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
    for (int c = 0; c < 6; ++c) S.v[c] = advance<call>(c, S.v[c]);
    if constexpr (call == Call::moves_history) history += history_of_point(step.n_branches) * lanes;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        P(i, j) += S.v[symmetric_index[i][j]];
        if constexpr (!is_small_strain)
          for (int k = 0; k < 3; ++k) P(i, j) += H(i, k) * S.v[symmetric_index[k][j]];
      }
  }

  // One component's history to the present; the stress that comes on top of the elastic one.
  template <Call call>
  [[gnu::always_inline]] Pack advance(int component, const Pack& S) const {
    double now[width], sum[width];
    double* const before = history + component * lanes;
    store_in_double(now, S);
    for (int l = 0; l < width; ++l) sum[l] = -step.share_sum * now[l];
    for (int b = 0; b < step.n_branches; ++b) {
      double* const h = history + (6 * (1 + b) + component) * lanes;
      for (int l = 0; l < width; ++l) {
        const double present = step.decay[b] * h[l] + step.gain[b] * (now[l] - before[l]);
        if constexpr (call == Call::moves_history) h[l] = present;
        sum[l] += present;
      }
    }
    RealOf<Pack> result[width];
    for (int l = 0; l < width; ++l) {
      if constexpr (call == Call::moves_history) before[l] = now[l];
      result[l] = static_cast<RealOf<Pack>>(sum[l]);
    }
    return load<Pack>(result);
  }
};

}  // namespace trocar
