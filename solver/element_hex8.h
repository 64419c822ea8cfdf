// Eight-node hexahedron, one point: mean gradients and total hourglass control (Flanagan and
// Belytschko 1981) in the modes of hex8_modes.h. With modal displacements w_m = sum_a S_m,a u_a and
// B_a = sum_m S_m,a b_m:
//   H = sum_m w_m (x) b_m        (b_6 = 0: the volume does not depend on xi eta zeta)
//   q_p = w_p - H X_p,  X_p = sum_a G_p,a X_a,  g_p = dW_hg/dq_p (hourglass.h)
//   f_a = sum_m S_m,a (P' b_m) + sum_p G_p,a g_p,  P' = V P - sum_p g_p (x) X_p.
// A translation gives exactly zero. In double not the b_m are held but what they are made of, the
// modes X_m: dV/dX costs 108 instructions of a step's 730 and saves 64 bytes. In single it would
// have to be done in double, a quarter of the step, or its rounding would turn a free body by 1e-5
// in 1e5 steps: there the b_m are held, rounded once, for 32 bytes.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/hex8_modes.h"
#include "solver/hourglass.h"
#include "solver/stash.h"
#include "solver/tensor.h"

namespace trocar {

template <class HourglassType>
struct OnePointHex8 {
  using Hourglass = HourglassType;
  static constexpr Formulation formulation = Hourglass::formulation;
  static constexpr int n_corners = 8;
  static constexpr int value_X = 0;                                  // X_3 … X_6 [m]
  static constexpr int value_k = value_X + 3 * n_hourglass_modes;    // of hourglass.h [N/m]
  static constexpr int value_shape = value_k + Hourglass::n_values;  // in double X_0 X_1 X_2 [m]
  static constexpr int value_inverse = value_shape + 9;              // and 1 / (64 V) [1/m^3],
  static constexpr int n_values = value_inverse + 1;
  static constexpr int n_b = 18, values_added_in_single = n_b - 10;  // in single b_0 … b_5 [1/m]
  static constexpr int n_kept = 3 * n_hourglass_modes + n_b;         // q and b
  static constexpr int kept_spared_in_single = n_b;

  // Of what is kept, behind the strain: q_0 … q_3, then b_0 … b_5.
  static constexpr int kept_q = 0, kept_b = 3 * n_hourglass_modes;

  // Keeps b_m = dV/dX_m / V of V = ([X_0 X_1 X_2] + ([X_4 X_3 X_2] + [X_5 X_1 X_3] + [X_0 X_5 X_4])
  // / 3) / 64, the exact volume (hex8_reference.h).
  template <class Pack>
  [[gnu::always_inline]] static void prepare(const BlockValues<Pack>& value,
                                             const Stash<Pack>& kept) {
    if constexpr (holds_b<Pack>) return;
    const Pack inverse = value(value_inverse), third = real<Pack>(1.0 / 3) * inverse;
    Pack X[6][3], d[6][3];  // d_m = X_m / (64 V), a third of it where m > 2
    for (int m = 0; m < 6; ++m)
      for (int i = 0; i < 3; ++i) {
        X[m][i] = value((m < 3 ? value_shape + 3 * m : value_X + 3 * (m - 3)) + i);
        d[m][i] = X[m][i] * (m < 3 ? inverse : third);
      }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      for (int m = 0; m < 3; ++m) {
        const int n = (m + 1) % 3, o = (m + 2) % 3, b = kept_b + 3 * m + i;
        kept.put(b, Pack((X[n][j] * d[o][k] - X[n][k] * d[o][j]) +
                         (X[3 + o][j] * d[3 + n][k] - X[3 + o][k] * d[3 + n][j])));
        kept.put(b + 9, Pack((X[o][j] * d[3 + n][k] - X[o][k] * d[3 + n][j]) +
                             (X[n][k] * d[3 + o][j] - X[n][j] * d[3 + o][k])));
      }
    }
  }

  // H; keeps q.
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[8][3],
                                                    const Stash<Pack>& kept) {
    Tensor<Pack> H;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      Pack w[n_hex_modes];
      modes_of_corners(u, i, w);
      for (int j = 0; j < 3; ++j) {
        H(i, j) = w[0] * b_of(value, kept, 0, j);
        for (int m = 1; m < 6; ++m) H(i, j) += w[m] * b_of(value, kept, m, j);
      }
      for (int p = 0; p < 4; ++p) {
        const int X = value_X + 3 * p;
        kept.put(kept_q + 3 * p + i, Pack(w[3 + p] - (H(i, 0) * value(X) + H(i, 1) * value(X + 1) +
                                                      H(i, 2) * value(X + 2))));
      }
    }
    return H;
  }

  template <class Pack>
  [[gnu::always_inline]] static void forces(const BlockValues<Pack>& value, const Stash<Pack>& kept,
                                            const Tensor<Pack>& VP, Pack (&f)[8][3]) {
    Pack g[n_hourglass_modes][3];
    hourglass_forces(value, kept, g);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      Pack P[3], w[n_hex_modes];
      for (int j = 0; j < 3; ++j) {
        P[j] = VP(i, j);
        for (int p = 0; p < 4; ++p) P[j] -= g[p][i] * value(value_X + 3 * p + j);
      }
      for (int m = 0; m < 6; ++m)
        w[m] = P[0] * b_of(value, kept, m, 0) + P[1] * b_of(value, kept, m, 1) +
               P[2] * b_of(value, kept, m, 2);
      for (int p = 0; p < 3; ++p) w[3 + p] += g[p][i];
      w[6] = g[3][i];
      corners_of_modes(w, i, f);
    }
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack hourglass_energy(const BlockValues<Pack>& value,
                                                      const Stash<Pack>& kept) {
    Pack g[n_hourglass_modes][3], sum = zero_of(kept.get(kept_q));
    hourglass_forces(value, kept, g);
    for (int p = 0; p < 4; ++p)
      for (int i = 0; i < 3; ++i) sum += kept.get(kept_q + 3 * p + i) * g[p][i];
    return 0.5 * sum;
  }

 private:
  template <class Pack>
  static constexpr bool holds_b = sizeof(RealOf<Pack>) == sizeof(float);

  template <class Pack>
  [[gnu::always_inline]] static Pack b_of(const BlockValues<Pack>& value, const Stash<Pack>& kept,
                                          int m, int i) {
    if constexpr (holds_b<Pack>)
      return value(value_shape + 3 * m + i);
    else
      return kept.get(kept_b + 3 * m + i);
  }

  template <class Pack>
  [[gnu::always_inline]] static void hourglass_forces(const BlockValues<Pack>& value,
                                                      const Stash<Pack>& kept,
                                                      Pack (&g)[n_hourglass_modes][3]) {
    Pack q[n_hourglass_modes][3];
    for (int p = 0; p < n_hourglass_modes; ++p)
      for (int i = 0; i < 3; ++i) q[p][i] = kept.get(kept_q + 3 * p + i);
    Hourglass::forces(BlockValues<Pack>{value.at + value_k * block_lanes<Pack>}, q, g);
  }
};

// Hourglass stiffness k, see hourglass.h.
using ElementHex8 = OnePointHex8<HourglassStiffness>;
// Its stiffness follows from the shape of the element.
using ElementHex8Enhanced = OnePointHex8<HourglassEnhanced>;

}  // namespace trocar
