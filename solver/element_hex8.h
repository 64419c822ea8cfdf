// Eight-node hexahedron, one point: mean gradients and total hourglass control (Flanagan and
// Belytschko 1981) in the modes of hex8_modes.h. With modal displacements w_m = sum_a S_m,a u_a and
// B_a = sum_m S_m,a b_m:
//   H = sum_m w_m (x) b_m        (b_6 = 0: the volume does not depend on xi eta zeta)
//   q_p = w_p - H X_p,  X_p = sum_a G_p,a X_a,  g_p = dW_hg/dq_p (hourglass.h)
//   f_a = sum_m S_m,a (P' b_m) + sum_p G_p,a g_p,  P' = V P - sum_p g_p (x) X_p.
// A translation gives exactly zero. The b_m are not held but made of the modes X_m in each step, a
// sixth of a hexahedron's operations: 21 numbers X_m are held in place of 30, the b_m and X_p. In
// single not even these are held but made of the nodes' positions (Model::position), which eight
// elements share: 12 to 16 bytes a node in place of 88 an element.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/hex8_modes.h"
#include "solver/hourglass.h"
#include "solver/stash.h"
#include "solver/tensor.h"

namespace trocar {

template <class HourglassType>
struct AlignedHex8;

template <class HourglassType>
struct OnePointHex8 {
  using Hourglass = HourglassType;
  using Aligned = AlignedHex8<HourglassType>;
  static constexpr Formulation formulation = Hourglass::formulation;
  static constexpr int n_corners = 8;
  static constexpr int value_k = 0;                                    // of hourglass.h [N/m]
  static constexpr int value_X = value_k + Hourglass::n_values;        // in double X_3 … X_6 [m],
  static constexpr int value_shape = value_X + 3 * n_hourglass_modes;  // X_0 X_1 X_2 [m]
  static constexpr int value_inverse = value_shape + 9;                // and 1 / (64 V) [1/m^3]
  static constexpr int n_values = value_inverse + 1;
  static constexpr int values_spared_in_single = n_values - value_X;
  static constexpr int n_b = 18, n_X = 3 * n_hourglass_modes;
  static constexpr int n_kept = 3 * n_hourglass_modes + n_b;  // q and b
  static constexpr int kept_added_in_single = n_X + 1;

  // Of what is kept, behind the strain: q_0 … q_3, then 64 V b_0 … 64 V b_5, whose factor H and P'
  // take; in single X_3 … X_6 and 1 / (64 V), too.
  static constexpr int kept_q = 0, kept_b = 3 * n_hourglass_modes, kept_X = kept_b + n_b;
  static constexpr int kept_inverse = kept_X + n_X;

  template <class Pack>
  static constexpr bool reads_positions = sizeof(RealOf<Pack>) == sizeof(float);

  // Keeps 64 dV/dX_m of 64 V = [X_0 X_1 X_2] + ([X_4 X_3 X_2] + [X_5 X_1 X_3] + [X_0 X_5 X_4]) / 3,
  // the exact volume (hex8_reference.h).
  template <class Pack>
  [[gnu::always_inline]] static void prepare(const BlockValues<Pack>& value,
                                             const Stash<Pack>& kept) {
    Pack X[6][3];
    for (int m = 0; m < 6; ++m)
      for (int i = 0; i < 3; ++i)
        X[m][i] = value((m < 3 ? value_shape + 3 * m : value_X + 3 * (m - 3)) + i);
    for_volume_gradient(
        X, [&](int m, int i, const Pack& b)
               __attribute__((always_inline)) { kept.put(kept_b + 3 * m + i, b); });
  }

  // The same of corners at x. V is made of the same modes, so that sum_m X_m (x) b_m = I but for
  // rounding. Keeps X_3 … X_6 and 1 / (64 V), too.
  template <class Pack>
  [[gnu::always_inline]] static void prepare(Pack (&x)[8][3], const Stash<Pack>& kept) {
    Pack X[6][3];
    for (int i = 0; i < 3; ++i) {
      for (int a = 1; a < 8; ++a) x[a][i] -= x[0][i];
      Pack w[n_hex_modes];
      modes_of_corners(x, i, w);
      for (int m = 0; m < 6; ++m) X[m][i] = w[m];
      for (int p = 0; p < 4; ++p) kept.put(kept_X + 3 * p + i, w[3 + p]);
    }
    Pack V = zero_of(X[0][0]);  // 64 V = X_0 . dV/dX_0 + X_3 . dV/dX_3
    for_volume_gradient(
        X, [&](int m, int i, const Pack& b) __attribute__((always_inline)) {
          kept.put(kept_b + 3 * m + i, b);
          if (m % 3 == 0) V += X[m][i] * b;
        });
    kept.put(kept_inverse, Pack(1.0 / V));
  }

  // H; keeps q. Each number that is kept or constant is read once, for all components.
  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[8][3],
                                                    const Stash<Pack>& kept) {
    Pack w[3][n_hex_modes];
    for (int i = 0; i < 3; ++i) modes_of_corners(u, i, w[i]);
    Tensor<Pack> H;
    const Pack inverse = inverse_of(value, kept);
    for (int j = 0; j < 3; ++j) {
      for (int m = 0; m < 6; ++m) {
        const Pack b = kept.get(kept_b + 3 * m + j);
        for (int i = 0; i < 3; ++i)
          H(i, j) = m == 0 ? Pack(w[i][m] * b) : Pack(H(i, j) + w[i][m] * b);
      }
      for (int i = 0; i < 3; ++i) H(i, j) *= inverse;
    }
    for (int p = 0; p < 4; ++p) {
      Pack X[3];
      for (int j = 0; j < 3; ++j) X[j] = X_of(value, kept, p, j);
      for (int i = 0; i < 3; ++i)
        kept.put(kept_q + 3 * p + i,
                 Pack(w[i][3 + p] - H(i, 0) * X[0] - H(i, 1) * X[1] - H(i, 2) * X[2]));
    }
    return H;
  }

  // Of f_a = sum_m S_m,a w_m, component by component.
  template <class Pack>
  [[gnu::always_inline]] static void force_modes(const BlockValues<Pack>& value,
                                                 const Stash<Pack>& kept, const Tensor<Pack>& VP,
                                                 Pack (&w)[3][n_hex_modes]) {
    Pack g[n_hourglass_modes][3];
    hourglass_forces(value, kept, g);
    Tensor<Pack> P = VP;
    for (int p = 0; p < 4; ++p)
      for (int j = 0; j < 3; ++j) {
        const Pack X = X_of(value, kept, p, j);
        for (int i = 0; i < 3; ++i) P(i, j) -= g[p][i] * X;
      }
    const Pack inverse = inverse_of(value, kept);
    for (int k = 0; k < 9; ++k) P(k / 3, k % 3) *= inverse;
    for (int m = 0; m < 6; ++m)
      for (int j = 0; j < 3; ++j) {
        const Pack b = kept.get(kept_b + 3 * m + j);
        for (int i = 0; i < 3; ++i)
          w[i][m] = j > 0    ? Pack(w[i][m] + P(i, j) * b)
                    : m >= 3 ? Pack(g[m - 3][i] + P(i, j) * b)
                             : Pack(P(i, j) * b);
      }
    for (int i = 0; i < 3; ++i) w[i][6] = g[3][i];
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

  template <class Pack>
  [[gnu::always_inline]] static Pack inverse_of(const BlockValues<Pack>& value,
                                                const Stash<Pack>& kept) {
    if constexpr (reads_positions<Pack>)
      return kept.get(kept_inverse);
    else
      return value(value_inverse);
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

 private:
  // Calls body(m, i, component i of 64 dV/dX_m), m < 6. With R_m = X_(3+m) / 3, and m n o cyclic,
  //   64 dV/dX_m = X_n x X_o - X_(3+n) x R_o
  //   64 dV/dX_(3+m) = -(X_n x R_o + R_n x X_o).
  template <class Pack, class Body>
  [[gnu::always_inline]] static void for_volume_gradient(const Pack (&X)[6][3], const Body& body) {
    constexpr auto third = real<Pack>(1.0 / 3);
    Pack R[3][3];
    for (int m = 0; m < 3; ++m)
      for (int i = 0; i < 3; ++i) R[m][i] = third * X[3 + m][i];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      for (int m = 0; m < 3; ++m) {
        const int n = (m + 1) % 3, o = (m + 2) % 3;
        body(m, i,
             Pack(X[n][j] * X[o][k] - X[n][k] * X[o][j] - X[3 + n][j] * R[o][k] +
                  X[3 + n][k] * R[o][j]));
        body(3 + m, i,
             Pack(X[n][k] * R[o][j] - X[n][j] * R[o][k] + R[n][k] * X[o][j] - R[n][j] * X[o][k]));
      }
    }
  }

  // Of X_3 … X_6.
  template <class Pack>
  [[gnu::always_inline]] static Pack X_of(const BlockValues<Pack>& value, const Stash<Pack>& kept,
                                          int p, int i) {
    if constexpr (reads_positions<Pack>)
      return kept.get(kept_X + 3 * p + i);
    else
      return value(value_X + 3 * p + i);
  }
};

// The same numbers, to the bit, for boxes whose edges xi, eta, zeta lie along x, y, z: of X_m,i and
// b_m,i those with m = i alone are not zero, so that 0.4 of a step's operations and 0.8 of its
// instructions are left.
template <class HourglassType>
struct AlignedHex8 {
  using Any = OnePointHex8<HourglassType>;
  static constexpr Formulation formulation = Any::formulation;
  static constexpr int n_corners = Any::n_corners, n_values = Any::n_values, n_kept = Any::n_kept;
  static constexpr int values_spared_in_single = Any::values_spared_in_single;
  template <class Pack>
  static constexpr bool reads_positions = Any::template reads_positions<Pack>;

  // Whether kernels read a value.
  static constexpr bool is_read(int value) {
    return value < Any::value_X || value == Any::value_inverse ||
           (value >= Any::value_shape && (value - Any::value_shape) % 4 == 0);
  }

  template <class Pack>
  [[gnu::always_inline]] static void prepare(const BlockValues<Pack>& value,
                                             const Stash<Pack>& kept) {
    keep_b({value(Any::value_shape), value(Any::value_shape + 4), value(Any::value_shape + 8)},
           kept);
  }
  // Of edges along x, y and z.
  template <class Pack>
  [[gnu::always_inline]] static void prepare(const Pack (&edge)[3], const Stash<Pack>& kept) {
    constexpr auto four = real<Pack>(4);
    keep_b({four * edge[0], four * edge[1], four * edge[2]}, kept);
    const Pack V = four * edge[0] * kept.get(Any::kept_b);  // times 64
    kept.put(Any::kept_inverse, Pack(1.0 / V));
  }

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[8][3],
                                                    const Stash<Pack>& kept) {
    Tensor<Pack> H;
    const Pack inverse = Any::inverse_of(value, kept);
    for (int i = 0; i < 3; ++i) {
      Pack w[n_hex_modes];
      modes_of_corners(u, i, w);
      for (int j = 0; j < 3; ++j) H(i, j) = w[j] * kept.get(Any::kept_b + 4 * j) * inverse;
      for (int p = 0; p < 4; ++p) kept.put(Any::kept_q + 3 * p + i, w[3 + p]);
    }
    return H;
  }

  // Products are rounded before corners_of_modes adds them, as they are in OnePointHex8, where a
  // sum rounds them or a further product needs them: `zero +` keeps the compiler from joining them
  // with those sums.
  template <class Pack>
  [[gnu::always_inline]] static void force_modes(const BlockValues<Pack>& value,
                                                 const Stash<Pack>& kept, const Tensor<Pack>& VP,
                                                 Pack (&w)[3][n_hex_modes]) {
    Pack g[n_hourglass_modes][3];
    Any::hourglass_forces(value, kept, g);
    const Pack inverse = Any::inverse_of(value, kept), zero = zero_of(inverse);
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < 3; ++m)
        w[i][m] = zero + VP(i, m) * inverse * kept.get(Any::kept_b + 4 * m);
      for (int p = 0; p < 4; ++p) w[i][3 + p] = zero + g[p][i];
    }
  }

 private:
  template <class Pack>
  [[gnu::always_inline]] static void keep_b(const Pack (&X)[3], const Stash<Pack>& kept) {
    for (int m = 0; m < 3; ++m)
      kept.put(Any::kept_b + 4 * m, Pack(X[(m + 1) % 3] * X[(m + 2) % 3]));
  }
};

// Hourglass stiffness k, see hourglass.h.
using ElementHex8 = OnePointHex8<HourglassStiffness>;
// Its stiffness follows from the shape of the element.
using ElementHex8Enhanced = OnePointHex8<HourglassEnhanced>;

}  // namespace trocar
