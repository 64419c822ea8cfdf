// Eight-node hexahedron, one point: mean gradients and total hourglass control (Flanagan and
// Belytschko 1981) in the modal basis of its corners, signs S_m,a of the monomials
//   m = 0..6: xi, eta, zeta, eta zeta, zeta xi, xi eta, xi eta zeta   (3..6 are G1..G4, hourglass).
// With modal displacements w_m = sum_a S_m,a u_a and B_a = sum_m S_m,a b_m:
//   H = sum_m w_m (x) b_m        (b_6 = 0: the volume does not depend on xi eta zeta)
//   q_p = w_p - H X_p,  X_p = sum_a G_p,a X_a,  W_hg = k/2 sum_p |q_p|^2
//   f_a = sum_m S_m,a (P' b_m) + k sum_p G_p,a q_p,  P' = V P - k sum_p q_p (x) X_p.
// The modes cost 7 x 3 values less than gradients per corner, and a translation gives exactly zero.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/tensor.h"

namespace trocar {

struct ElementHex8 {
  static constexpr Formulation formulation = Formulation::hex8_one_point;
  static constexpr int n_corners = 8;
  static constexpr int value_b = 0;             // b_0 … b_5 [1/m]
  static constexpr int value_X = value_b + 18;  // X_3 … X_6 [m]
  static constexpr int value_k = value_X + 12;  // hourglass stiffness [N/m]
  static constexpr int n_values = value_k + 1;

  template <class Pack>
  struct Strain {
    Tensor<Pack> H;
    Pack q[4][3];
  };

  template <class Pack>
  [[gnu::always_inline]] static Strain<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[8][3]) {
    Strain<Pack> s;
    for (int i = 0; i < 3; ++i) {
      Pack w[7];
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
    const Pack k = value(value_k);
    for (int i = 0; i < 3; ++i) {
      Pack kq[4], P[3], g[7];
      for (int p = 0; p < 4; ++p) kq[p] = k * s.q[p][i];
      for (int j = 0; j < 3; ++j) {
        P[j] = VP(i, j);
        for (int p = 0; p < 4; ++p) P[j] -= kq[p] * value(value_X + 3 * p + j);
      }
      for (int m = 0; m < 6; ++m) {
        const int b = value_b + 3 * m;
        g[m] = P[0] * value(b) + P[1] * value(b + 1) + P[2] * value(b + 2);
      }
      for (int p = 0; p < 3; ++p) g[3 + p] += kq[p];
      g[6] = kq[3];
      corners_of_modes(g, i, f);
    }
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack hourglass_energy(const BlockValues<Pack>& value,
                                                      const Strain<Pack>& s) {
    Pack sum = zero_of(s.H(0, 0));
    for (int p = 0; p < 4; ++p)
      for (int i = 0; i < 3; ++i) sum += s.q[p][i] * s.q[p][i];
    return 0.5 * value(value_k) * sum;
  }

 private:
  // w_m = sum_a S_m,a u_a as a butterfly: edges along xi, then faces, then the whole.
  template <class Pack>
  [[gnu::always_inline]] static void modes_of_corners(const Pack (&u)[8][3], int i, Pack (&w)[7]) {
    const Pack s0 = u[1][i] + u[0][i], d0 = u[1][i] - u[0][i];  // eta-, zeta-
    const Pack s1 = u[2][i] + u[3][i], d1 = u[2][i] - u[3][i];  // eta+, zeta-
    const Pack s2 = u[5][i] + u[4][i], d2 = u[5][i] - u[4][i];  // eta-, zeta+
    const Pack s3 = u[6][i] + u[7][i], d3 = u[6][i] - u[7][i];  // eta+, zeta+
    const Pack low_s = s1 + s0, low_se = s1 - s0, high_s = s3 + s2, high_se = s3 - s2;
    const Pack low_d = d1 + d0, low_de = d1 - d0, high_d = d3 + d2, high_de = d3 - d2;
    w[0] = high_d + low_d;
    w[1] = high_se + low_se;
    w[2] = high_s - low_s;
    w[3] = high_se - low_se;
    w[4] = high_d - low_d;
    w[5] = high_de + low_de;
    w[6] = high_de - low_de;
  }

  // f_a = sum_m S_m,a g_m, the same butterfly backwards.
  template <class Pack>
  [[gnu::always_inline]] static void corners_of_modes(const Pack (&g)[7], int i, Pack (&f)[8][3]) {
    const Pack high_se = g[1] + g[3], low_se = g[1] - g[3];
    const Pack high_d = g[0] + g[4], low_d = g[0] - g[4];
    const Pack high_de = g[5] + g[6], low_de = g[5] - g[6];
    const Pack s3 = g[2] + high_se, s2 = g[2] - high_se;
    const Pack s1 = low_se - g[2], s0 = -(low_se + g[2]);
    const Pack d3 = high_d + high_de, d2 = high_d - high_de;
    const Pack d1 = low_d + low_de, d0 = low_d - low_de;
    f[0][i] = s0 - d0;
    f[1][i] = s0 + d0;
    f[2][i] = s1 + d1;
    f[3][i] = s1 - d1;
    f[4][i] = s2 - d2;
    f[5][i] = s2 + d2;
    f[6][i] = s3 + d3;
    f[7][i] = s3 - d3;
  }
};

}  // namespace trocar
