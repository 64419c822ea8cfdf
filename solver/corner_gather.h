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
    // The wanted numbers stand at different places of the three: blended, then put in order.
    const auto blend =
        [](const Pack& of_0, const Pack& of_1, const Pack& of_2) __attribute__((always_inline)) {
      const Pack of_01 = __builtin_shufflevector(of_0, of_1, 0, 9, 2, 3, 12, 5, 6, 15);
      return __builtin_shufflevector(of_01, of_2, 0, 1, 10, 3, 4, 13, 6, 7);
    };
    const Pack xs = blend(a, b, c), ys = blend(c, a, b), zs = blend(b, c, a);
    x[0] = __builtin_shufflevector(xs, xs, 0, 3, 6, 1, 4, 7, 2, 5);
    x[1] = __builtin_shufflevector(ys, ys, 1, 4, 7, 2, 5, 0, 3, 6);
    x[2] = __builtin_shufflevector(zs, zs, 2, 5, 0, 3, 6, 1, 4, 7);
  }
}

// Of nodes anywhere, the first number of each at u + first[lane]. Reads a double behind each node:
// masked loads cost 6 to 9 % of a step.
template <class Pack>
[[gnu::always_inline]] inline void gather_nodes(const double* u, const std::int32_t* node,
                                                Pack (&x)[3]) {
  constexpr int width = pack_width<Pack>;
  const auto at = [&](int lane) {
    return u + 3 * std::size_t{static_cast<std::uint32_t>(node[lane])};
  };
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
  static constexpr auto first = [] {
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
      for (int a = 0; a < n; ++a) gather_nodes(copies.u, Copies::first.data() + a * lanes, x[a]);
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
  if constexpr (pack_width<Pack> == 16) {
    const Pack first = _mm512_castps256_ps512(low);
    return _mm512_mask_insertf32x8(first, 0xFFFF, first, high, 1);  // two instructions fewer
  } else {
    return __builtin_shufflevector(low, high, k...);
  }
}

// Numbers i, i + 3, … of three registers.
template <int i, class Pack, std::size_t... k>
[[gnu::always_inline]] inline Pack every_third(const Pack (&row)[3], std::index_sequence<k...>) {
  constexpr std::size_t width = sizeof...(k), two = 2 * width;
  const Pack low = __builtin_shufflevector(row[0], row[1], (3 * k + i < two ? 3 * k + i : 0)...);
  return __builtin_shufflevector(low, row[2], (3 * k + i < two ? k : width + (3 * k + i - two))...);
}

// Differences to the first corner, rounded, of sixteen lanes that stand in two rows: rounded first,
// put in order afterwards, half as many registers.
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_two_rows(const double* u, const std::int32_t* corner,
                                                   Pack (&x)[n][3]) {
  using Half = PackOf<double, row_lanes>;
  using Lanes = std::make_index_sequence<2 * row_lanes>;
  const auto eight = [&](int a, int k) __attribute__((always_inline)) {
    const std::int64_t node = corner[a * 2 * row_lanes + (k < 3 ? 0 : row_lanes)];
    return load<Half>(u + 3 * node + row_lanes * (k % 3));
  };
  Half first[6];
  for (int k = 0; k < 6; ++k) first[k] = eight(0, k);
  for (int i = 0; i < 3; ++i) x[0][i] = Pack{};
#pragma GCC unroll 8
  for (int a = 1; a < n; ++a) {
    Pack row[3];
    for (int r = 0; r < 3; ++r)
      row[r] = join<Pack>(in_single(Half(eight(a, 2 * r) - first[2 * r])),
                          in_single(Half(eight(a, 2 * r + 1) - first[2 * r + 1])), Lanes{});
    x[a][0] = every_third<0>(row, Lanes{});
    x[a][1] = every_third<1>(row, Lanes{});
    x[a][2] = every_third<2>(row, Lanes{});
  }
}

// Differences to the first corner, rounded, by halves of a register.
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_singles(const double* u, const std::int32_t* corner,
                                                  const std::uint32_t* row, Pack (&x)[n][3]) {
  if constexpr (pack_width<Pack> == 2 * row_lanes)
    if (is_row(row[0]) && is_row(row[1])) return gather_two_rows(u, corner, x);
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
