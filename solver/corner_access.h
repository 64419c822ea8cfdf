// Between nodes in memory and lanes in registers: displacements in, corner forces out.
#pragma once

#include <cstdint>

#include "solver/pack.h"

namespace trocar {

// The three displacements of a node and a zero. Masked: behind the last node the array ends.
template <class Quad>
[[gnu::always_inline]] inline Quad load_node(const double* u, std::int32_t node) {
  return _mm256_maskload_pd(u + 3 * std::int64_t{node}, Quad{0, 0, 0, 1} == Quad{});
}

template <class Pack>
[[gnu::always_inline]] inline void gather_corner(const double* u, const std::int32_t* node,
                                                 Pack (&x)[3]) {
  constexpr int width = pack_width<Pack>;
  using Quad = PackOf<4>::Real;
  if constexpr (width == 1) {
    for (int i = 0; i < 3; ++i) x[i] = u[3 * std::int64_t{node[0]} + i];
  } else if constexpr (width == 2) {
    const double *a = u + 3 * std::int64_t{node[0]}, *b = u + 3 * std::int64_t{node[1]};
    for (int i = 0; i < 3; ++i) x[i] = Pack{a[i], b[i]};
  } else if constexpr (width == 4) {
    Pack row[4];
    for (int lane = 0; lane < 4; ++lane) row[lane] = load_node<Pack>(u, node[lane]);
    const Pack xz0 = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
    const Pack xz2 = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
    const Pack y0 = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
    const Pack y2 = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    x[0] = __builtin_shufflevector(xz0, xz2, 0, 1, 4, 5);
    x[1] = __builtin_shufflevector(y0, y2, 0, 1, 4, 5);
    x[2] = __builtin_shufflevector(xz0, xz2, 2, 3, 6, 7);
  } else {
    Pack row[4];  // lane and lane + 4
    for (int lane = 0; lane < 4; ++lane)
      row[lane] =
          __builtin_shufflevector(load_node<Quad>(u, node[lane]),
                                  load_node<Quad>(u, node[lane + 4]), 0, 1, 2, 3, 4, 5, 6, 7);
    const Pack xz0 = __builtin_shufflevector(row[0], row[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack xz2 = __builtin_shufflevector(row[2], row[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack y0 = __builtin_shufflevector(row[0], row[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const Pack y2 = __builtin_shufflevector(row[2], row[3], 1, 9, 3, 11, 5, 13, 7, 15);
    x[0] = __builtin_shufflevector(xz0, xz2, 0, 1, 8, 9, 4, 5, 12, 13);
    x[1] = __builtin_shufflevector(y0, y2, 0, 1, 8, 9, 4, 5, 12, 13);
    x[2] = __builtin_shufflevector(xz0, xz2, 2, 3, 10, 11, 6, 7, 14, 15);
  }
}

// To [lane][4], the last of four being zero.
template <class Pack>
[[gnu::always_inline]] inline void store_corner(double* to, const Pack (&f)[3]) {
  constexpr int width = pack_width<Pack>;
  const Pack zero = Pack{} + 0.0;
  if constexpr (width == 1) {
    for (int i = 0; i < 3; ++i) to[i] = f[i];
    to[3] = zero;
  } else if constexpr (width == 2) {
    store(to, __builtin_shufflevector(f[0], f[1], 0, 2));
    store(to + 2, __builtin_shufflevector(f[2], zero, 0, 2));
    store(to + 4, __builtin_shufflevector(f[0], f[1], 1, 3));
    store(to + 6, __builtin_shufflevector(f[2], zero, 1, 3));
  } else if constexpr (width == 4) {
    // xy0: x0 y0 x2 y2, xy1: x1 y1 x3 y3, z likewise with zeros; then halves are swapped.
    const Pack xy0 = __builtin_shufflevector(f[0], f[1], 0, 4, 2, 6);
    const Pack xy1 = __builtin_shufflevector(f[0], f[1], 1, 5, 3, 7);
    const Pack z0 = __builtin_shufflevector(f[2], zero, 0, 4, 2, 6);
    const Pack z1 = __builtin_shufflevector(f[2], zero, 1, 5, 3, 7);
    store(to, __builtin_shufflevector(xy0, z0, 0, 1, 4, 5));
    store(to + 4, __builtin_shufflevector(xy1, z1, 0, 1, 4, 5));
    store(to + 8, __builtin_shufflevector(xy0, z0, 2, 3, 6, 7));
    store(to + 12, __builtin_shufflevector(xy1, z1, 2, 3, 6, 7));
  } else {
    const Pack xy0 = __builtin_shufflevector(f[0], f[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack xy1 = __builtin_shufflevector(f[0], f[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const Pack z0 = __builtin_shufflevector(f[2], zero, 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack z1 = __builtin_shufflevector(f[2], zero, 1, 9, 3, 11, 5, 13, 7, 15);
    // Now pairs (x y) and (z 0) of lanes 0 2 4 6 and 1 3 5 7; each store takes two lanes' four.
    const Pack low0 = __builtin_shufflevector(xy0, z0, 0, 1, 8, 9, 2, 3, 10, 11);
    const Pack low1 = __builtin_shufflevector(xy1, z1, 0, 1, 8, 9, 2, 3, 10, 11);
    const Pack high0 = __builtin_shufflevector(xy0, z0, 4, 5, 12, 13, 6, 7, 14, 15);
    const Pack high1 = __builtin_shufflevector(xy1, z1, 4, 5, 12, 13, 6, 7, 14, 15);
    store(to, __builtin_shufflevector(low0, low1, 0, 1, 2, 3, 8, 9, 10, 11));
    store(to + 8, __builtin_shufflevector(low0, low1, 4, 5, 6, 7, 12, 13, 14, 15));
    store(to + 16, __builtin_shufflevector(high0, high1, 0, 1, 2, 3, 8, 9, 10, 11));
    store(to + 24, __builtin_shufflevector(high0, high1, 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

}  // namespace trocar
