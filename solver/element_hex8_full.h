// Eight-node hexahedron with 2 x 2 x 2 Gauss points, the expensive reference: no hourglass modes,
// but locks when nu tends to 1/2. In the modes of hex8_modes.h, with dS_m = grad_xi of the monomial
// at a point and C = (dX/dxi)^-1 / 8 there:
//   H = (sum_m w_m (x) dS_m) C,   f_a = sum_m S_m,a g_m,   g_m = sum_points (V_point P C^T) dS_m.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/hex8_modes.h"
#include "solver/stash.h"

namespace trocar {

// sqrt(1/3): abscissa of the two-point Gauss rule.
inline constexpr double gauss_point = 0.57735026918962576451;

struct ElementHex8Full {
  static constexpr Formulation formulation = Formulation::hex8_full;
  static constexpr LawKind law = LawKind::local;
  static constexpr int n_corners = 8;
  static constexpr int n_points = 8;
  static constexpr int value_share = 9;  // of a point, behind C: V_point / V
  static constexpr int values_of_point = 10;
  static constexpr int n_values = n_points * values_of_point;

  static constexpr int n_kept = 0;

  template <class Pack>
  [[gnu::always_inline]] static void strain(const BlockValues<Pack>& value, const Pack (&u)[8][3],
                                            const Stash<Pack>& stash) {
    Pack w[n_hex_modes][3];
    for (int i = 0; i < 3; ++i) {
      Pack mode[n_hex_modes];
      modes_of_corners(u, i, mode);
      for (int m = 0; m < n_hex_modes; ++m) w[m][i] = mode[m];
    }
    for_points(
        value, [&](const Point<Pack>& point, int k)
                   __attribute__((always_inline)) { stash.put_tensor(k, gradient(point, w)); });
  }

  template <class Pack>
  [[gnu::always_inline]] static void force_modes(const BlockValues<Pack>& value,
                                                 const Stash<Pack>& stash,
                                                 Pack (&w)[3][n_hex_modes]) {
    Pack g[n_hex_modes][3];
    for (auto& mode : g)
      for (Pack& x : mode) x = zero_of(stash.get(0));
    for_points(
        value, [&](const Point<Pack>& point, int k)
                   __attribute__((always_inline)) { add_point(point, stash.get_tensor(k), g); });
    for (int i = 0; i < 3; ++i)
      for (int m = 0; m < n_hex_modes; ++m) w[i][m] = g[m][i];
  }

  template <class Pack>
  [[gnu::always_inline]] static Pack hourglass_energy(const BlockValues<Pack>&,
                                                      const Stash<Pack>& stash) {
    return zero_of(stash.get(0));
  }

 private:
  template <class Pack>
  struct Point {
    RealOf<Pack> x, y, z;  // xi, eta, zeta
    BlockValues<Pack> value;
  };

  // Calls body(point, its number) for each point. Not unrolled: that would be much code.
  template <class Pack, class Body>
  [[gnu::always_inline]] static void for_points(const BlockValues<Pack>& value, const Body& body) {
#pragma GCC unroll 1
    for (int k = 0; k < n_points; ++k) {
      constexpr auto g = real<Pack>(gauss_point);
      body(Point<Pack>{(k & 1) != 0 ? g : -g,
                       (k & 2) != 0 ? g : -g,
                       (k & 4) != 0 ? g : -g,
                       {value.at + k * values_of_point * block_lanes<Pack>}},
           k);
    }
  }

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> gradient(const Point<Pack>& p,
                                                      const Pack (&w)[n_hex_modes][3]) {
    Tensor<Pack> H;
    for (int i = 0; i < 3; ++i) {
      const Pack dx = w[0][i] + p.z * w[4][i] + p.y * (w[5][i] + p.z * w[6][i]);
      const Pack dy = w[1][i] + p.x * w[5][i] + p.z * (w[3][i] + p.x * w[6][i]);
      const Pack dz = w[2][i] + p.y * w[3][i] + p.x * (w[4][i] + p.y * w[6][i]);
      for (int j = 0; j < 3; ++j)
        H(i, j) = dx * p.value(j) + dy * p.value(3 + j) + dz * p.value(6 + j);
    }
    return H;
  }

  // VP: stress times the volume of the whole element.
  template <class Pack>
  [[gnu::always_inline]] static void add_point(const Point<Pack>& p, const Tensor<Pack>& VP,
                                               Pack (&g)[n_hex_modes][3]) {
    const Pack share = p.value(value_share);
    for (int i = 0; i < 3; ++i) {
      Pack T[3];
      for (int k = 0; k < 3; ++k)
        T[k] = share * (VP(i, 0) * p.value(3 * k) + VP(i, 1) * p.value(3 * k + 1) +
                        VP(i, 2) * p.value(3 * k + 2));
      g[0][i] += T[0];
      g[1][i] += T[1];
      g[2][i] += T[2];
      g[3][i] += p.z * T[1] + p.y * T[2];
      g[4][i] += p.x * T[2] + p.z * T[0];
      g[5][i] += p.y * T[0] + p.x * T[1];
      g[6][i] += p.y * (p.z * T[0]) + p.x * (p.z * T[1]) + p.x * (p.y * T[2]);
    }
  }
};

}  // namespace trocar
