// From nodes in memory to lanes in registers. Nodes are in double always; single-precision elements
// get differences to their first corner, so that a body that is far from where it started keeps its
// strains.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "solver/in_double.h"
#include "solver/row_order.h"

namespace trocar {

// Three registers of nodes that follow each other, of which every third number is taken.
template <class Pack>
[[gnu::always_inline]] inline void gather_row(const double* u, Pack (&x)[3]) {
  constexpr int width = pack_width<Pack>;
  const Pack a = load<Pack>(u), b = load<Pack>(u + width), c = load<Pack>(u + 2 * width);
  if constexpr (width == 4) {
    x[0] = __builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 6), c, 0, 1, 2, 5);
    x[1] = __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 7), c, 0, 1, 2, 6);
    x[2] = __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 5, 5), c, 0, 1, 4, 7);
  } else {
    const Pack x5 = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0);
    const Pack y5 = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0);
    const Pack z5 = __builtin_shufflevector(a, b, 2, 5, 8, 11, 14, 0, 0, 0);
    x[0] = __builtin_shufflevector(x5, c, 0, 1, 2, 3, 4, 5, 10, 13);
    x[1] = __builtin_shufflevector(y5, c, 0, 1, 2, 3, 4, 8, 11, 14);
    x[2] = __builtin_shufflevector(z5, c, 0, 1, 2, 3, 4, 9, 12, 15);
  }
}

// Of nodes anywhere. Reads a double behind each node: masked loads cost 6 to 9 % of a step.
template <class Pack>
[[gnu::always_inline]] inline void gather_nodes(const double* u, const std::int32_t* node,
                                                Pack (&x)[3]) {
  constexpr int width = pack_width<Pack>;
  const auto at = [&](int lane) { return u + 3 * std::int64_t{node[lane]}; };
  if constexpr (width == 1) {
    for (int i = 0; i < 3; ++i) x[i] = at(0)[i];
  } else if constexpr (width == 2) {
    const double *a = at(0), *b = at(1);
    for (int i = 0; i < 3; ++i) x[i] = Pack{a[i], b[i]};
  } else if constexpr (width == 4) {
    Pack row[4];
    for (int lane = 0; lane < 4; ++lane) row[lane] = load<Pack>(at(lane));
    const Pack xz0 = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
    const Pack xz2 = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
    const Pack y0 = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
    const Pack y2 = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    x[0] = __builtin_shufflevector(xz0, xz2, 0, 1, 4, 5);
    x[1] = __builtin_shufflevector(y0, y2, 0, 1, 4, 5);
    x[2] = __builtin_shufflevector(xz0, xz2, 2, 3, 6, 7);
  } else {
    using Quad = PackOf<double, 4>;
    Pack row[4];  // lanes k and k + 4: the second half comes from memory without a shuffle
    for (int k = 0; k < 4; ++k) {
      const Pack low = _mm512_castpd256_pd512(load<Quad>(at(k)));
      row[k] = _mm512_mask_insertf64x4(low, 0xFF, low, load<Quad>(at(k + 4)), 1);
    }
    const Pack xz0 = __builtin_shufflevector(row[0], row[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack xz2 = __builtin_shufflevector(row[2], row[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack y0 = __builtin_shufflevector(row[0], row[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const Pack y2 = __builtin_shufflevector(row[2], row[3], 1, 9, 3, 11, 5, 13, 7, 15);
    x[0] = __builtin_shufflevector(xz0, xz2, 0, 1, 8, 9, 4, 5, 12, 13);
    x[1] = __builtin_shufflevector(y0, y2, 0, 1, 8, 9, 4, 5, 12, 13);
    x[2] = __builtin_shufflevector(xz0, xz2, 2, 3, 10, 11, 6, 7, 14, 15);
  }
}

// A copy of the nodes of a group, behind which a double may be read.
template <class Pack, int n, int lanes>
struct NodeCopies {
  static constexpr auto corner = [] {
    std::array<std::int32_t, n * lanes> number{};
    for (int k = 0; k < n * lanes; ++k) number[k] = k;
    return number;
  }();
  double u[3 * n * lanes + 1];

  [[gnu::always_inline]] NodeCopies(const double* from, const std::int32_t* node) {
    for (int a = 0; a < n; ++a)
      for (int lane = 0; lane < pack_width<Pack>; ++lane) {
        const int k = a * lanes + lane;
        for (int i = 0; i < 3; ++i) u[3 * k + i] = from[3 * std::int64_t{node[k]} + i];
      }
    u[3 * n * lanes] = 0;
  }
};

// Displacements of all corners of as many lanes as Pack has, of `lanes` in a block.
template <int lanes, class Pack, int n>
[[gnu::always_inline]] inline void gather_doubles(const double* u, const std::int32_t* corner,
                                                  std::uint32_t row, Pack (&x)[n][3]) {
  if constexpr (pack_width < Pack >> 2) {
    if (is_row(row)) {
#pragma GCC unroll 8
      for (int a = 0; a < n; ++a) gather_row(u + 3 * std::int64_t{corner[a * lanes]}, x[a]);
      return;
    }
    if (row == no_row_at_end) {
      using Copies = NodeCopies<Pack, n, lanes>;
      const Copies copies(u, corner);
      for (int a = 0; a < n; ++a) gather_nodes(copies.u, Copies::corner.data() + a * lanes, x[a]);
      return;
    }
  }
#pragma GCC unroll 8
  for (int a = 0; a < n; ++a) gather_nodes(u, corner + a * lanes, x[a]);
}

// Lanes of two registers as one, the first one's first.
template <class Pack, class Half, std::size_t... k>
[[gnu::always_inline]] inline Pack join(const Half& low, const Half& high,
                                        std::index_sequence<k...>) {
  return __builtin_shufflevector(low, high, k...);
}

// Differences to the first corner, rounded, by halves of a register.
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_singles(const double* u, const std::int32_t* corner,
                                                  const std::uint32_t* row, Pack (&x)[n][3]) {
  constexpr int width = pack_width<Pack> / 2;
  PackOf<double, width> low[n][3], high[n][3];
  gather_doubles<block_lanes<Pack>>(u, corner, row[0], low);
  gather_doubles<block_lanes<Pack>>(u, corner + width, row[width / row_lanes], high);
#pragma GCC unroll 8
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < 3; ++i)
      x[a][i] = join<Pack>(in_single(low[a][i] - low[0][i]), in_single(high[a][i] - high[0][i]),
                           std::make_index_sequence<pack_width<Pack>>{});
}

// Displacements of all corners of a group; corner[corner][lane], row of its lanes.
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_corners(const double* u, const std::int32_t* corner,
                                                  const std::uint32_t* row, Pack (&x)[n][3]) {
  if constexpr (sizeof(RealOf<Pack>) == sizeof(double)) {
    gather_doubles<block_lanes<Pack>>(u, corner, row[0], x);
  } else if constexpr (pack_width<Pack> == 1) {
    double d[n][3];
    gather_doubles<block_lanes<Pack>>(u, corner, row[0], d);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i) x[a][i] = Pack{static_cast<float>(d[a][i] - d[0][i])};
  } else {
    gather_singles(u, corner, row, x);
  }
}

}  // namespace trocar
