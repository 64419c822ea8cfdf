// Eight-node hexahedron, one point: mean gradients and total hourglass control (Flanagan and
// Belytschko 1981) in the modes of hex8_modes.h. With modal displacements w_m = sum_a S_m,a u_a and
// B_a = sum_m S_m,a b_m:
//   H = sum_m w_m (x) b_m        (b_6 = 0: the volume does not depend on xi eta zeta)
//   q_p = w_p - H X_p,  X_p = sum_a G_p,a X_a,  g_p = dW_hg/dq_p (hourglass.h)
//   f_a = sum_m S_m,a (P' b_m) + sum_p G_p,a g_p,  P' = V P - sum_p g_p (x) X_p.
// The modes cost 7 x 3 values less than gradients per corner, and a translation gives exactly zero.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/hex8_modes.h"
#include "solver/hourglass.h"
#include "solver/tensor.h"

namespace trocar {

template <class HourglassType>
struct OnePointHex8 {
  using Hourglass = HourglassType;
  static constexpr Formulation formulation = Hourglass::formulation;
  static constexpr int n_corners = 8;
  static constexpr int value_b = 0;             // b_0 … b_5 [1/m]
  static constexpr int value_X = value_b + 18;  // X_3 … X_6 [m]
  static constexpr int value_k = value_X + 12;  // hourglass stiffness of hourglass.h [N/m]
  static constexpr int n_values = value_k + Hourglass::n_values;
  static constexpr int n_kept = 3 * n_hourglass_modes;

  template <class Pack>
  struct Strain {
    Tensor<Pack> H;
    Pack q[n_hourglass_modes][3];
  };

  template <class Pack>
  [[gnu::always_inline]] static Strain<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[8][3]) {
    Strain<Pack> s;
    for (int i = 0; i < 3; ++i) {
      Pack w[n_hex_modes];
      modes_of_corners(u, i, w);
      for (int j = 0; j < 3; ++j) {
        s.H(i, j) = w[0] * value(value_b + j);
        for (int m = 1; m < 6; ++m) s.H(i, j) += w[m] * value(value_b + 3 * m + j);
      }
      for (int p = 0; p < 4; ++p) {
        const int X = value_X + 3 * p;
        s.q[p][i] =
            w[3 + p] - (s.H(i, 0) * value(X) + s.H(i, 1) * value(X + 1) + s.H(i, 2) * value(X + 2));
      }
    }
    return s;
  }

  template <class Pack>
  [[gnu::always_inline]] static void forces(const BlockValues<Pack>& value, const Strain<Pack>& s,
                                            const Tensor<Pack>& VP, Pack (&f)[8][3]) {
    Pack g[n_hourglass_modes][3];
    hourglass_forces(value, s, g);
    for (int i = 0; i < 3; ++i) {
      Pack P[3], w[n_hex_modes];
      for (int j = 0; j < 3; ++j) {
        P[j] = VP(i, j);
        for (int p = 0; p < 4; ++p) P[j] -= g[p][i] * value(value_X + 3 * p + j);
      }
      for (int m = 0; m < 6; ++m) {
        const int b = value_b + 3 * m;
        w[m] = P[0] * value(b) + P[1] * value(b + 1) + P[2] * value(b + 2);
      }
      for (int p = 0; p < 3; ++p) w[3 + p] += g[p][i];
      w[6] = g[3][i];
      corners_of_modes(w, i, f);
    }
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack hourglass_energy(const BlockValues<Pack>& value,
                                                      const Strain<Pack>& s) {
    Pack g[n_hourglass_modes][3], sum = zero_of(s.q[0][0]);
    hourglass_forces(value, s, g);
    for (int p = 0; p < 4; ++p)
      for (int i = 0; i < 3; ++i) sum += s.q[p][i] * g[p][i];
    return 0.5 * sum;
  }

 private:
  template <class Pack>
  [[gnu::always_inline]] static void hourglass_forces(const BlockValues<Pack>& value,
                                                      const Strain<Pack>& s,
                                                      Pack (&g)[n_hourglass_modes][3]) {
    Hourglass::forces(BlockValues<Pack>{value.at + value_k * block_lanes<Pack>}, s.q, g);
  }
};

// Hourglass stiffness k, see hourglass.h.
using ElementHex8 = OnePointHex8<HourglassStiffness>;
// Its stiffness follows from the shape of the element.
using ElementHex8Enhanced = OnePointHex8<HourglassEnhanced>;

}  // namespace trocar
