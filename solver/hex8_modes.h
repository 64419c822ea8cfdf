// The corners of a hexahedron in modes: signs S_m,a of the monomials
//   m = 0..6: xi, eta, zeta, eta zeta, zeta xi, xi eta, xi eta zeta   (3..6 are G1..G4, hourglass)
// at corner a. Differences only, so that a translation gives exactly zero.
#pragma once

#include "solver/pack.h"

namespace trocar {

inline constexpr int n_hex_modes = 7;

// w_m = sum_a S_m,a u_a as a butterfly: edges along xi, then faces, then the whole. In single
// precision u are differences to corner 0, whose own are not read.
template <class Pack>
[[gnu::always_inline]] inline void modes_of_corners(const Pack (&u)[8][3], int i,
                                                    Pack (&w)[n_hex_modes]) {
  constexpr bool is_relative = sizeof(RealOf<Pack>) == sizeof(float);
  const Pack s0 = is_relative ? u[1][i] : Pack(u[1][i] + u[0][i]);  // eta-, zeta-
  const Pack d0 = is_relative ? u[1][i] : Pack(u[1][i] - u[0][i]);
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
[[gnu::always_inline]] inline void corners_of_modes(const Pack (&g)[n_hex_modes], Pack (&f)[8]) {
  const Pack high_se = g[1] + g[3], low_se = g[1] - g[3];
  const Pack high_d = g[0] + g[4], low_d = g[0] - g[4];
  const Pack high_de = g[5] + g[6], low_de = g[5] - g[6];
  const Pack s3 = g[2] + high_se, s2 = g[2] - high_se;
  const Pack s1 = low_se - g[2], s0 = -(low_se + g[2]);
  const Pack d3 = high_d + high_de, d2 = high_d - high_de;
  const Pack d1 = low_d + low_de, d0 = low_d - low_de;
  f[0] = s0 - d0;
  f[1] = s0 + d0;
  f[2] = s1 + d1;
  f[3] = s1 - d1;
  f[4] = s2 - d2;
  f[5] = s2 + d2;
  f[6] = s3 + d3;
  f[7] = s3 - d3;
}

}  // namespace trocar
