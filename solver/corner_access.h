// Between nodes in memory and lanes in registers: displacements in, corner forces out. Nodes are in
// double always; single-precision elements get differences to their first corner, so that a body
// that is far from where it started keeps its strains.
#pragma once

#include <cstdint>
#include <utility>

#include "solver/block_data.h"
#include "solver/row_order.h"

namespace trocar {

// The three displacements of a node and a zero. Masked: behind the last node the array ends.
template <class Quad>
[[gnu::always_inline]] inline Quad load_node(const double* u, std::int32_t node) {
  return _mm256_maskload_pd(u + 3 * std::int64_t{node}, Quad{0, 0, 0, 1} == Quad{});
}

// The same of nodes that follow each other: three registers, of which every third number is taken.
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

template <class Pack>
[[gnu::always_inline]] inline void gather_corner(const double* u, const std::int32_t* node,
                                                 bool is_row, Pack (&x)[3]) {
  constexpr int width = pack_width<Pack>;
  using Quad = PackOf<double, 4>;
  if constexpr (width == 1) {
    for (int i = 0; i < 3; ++i) x[i] = u[3 * std::int64_t{node[0]} + i];
  } else if constexpr (width == 2) {
    const double *a = u + 3 * std::int64_t{node[0]}, *b = u + 3 * std::int64_t{node[1]};
    for (int i = 0; i < 3; ++i) x[i] = Pack{a[i], b[i]};
  } else if (is_row) {
    gather_row(u + 3 * std::int64_t{node[0]}, x);
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
    Pack row[4];  // lanes 2 k and 2 k + 1
    for (int k = 0; k < 4; ++k)
      row[k] = __builtin_shufflevector(load_node<Quad>(u, node[2 * k]),
                                       load_node<Quad>(u, node[2 * k + 1]), 0, 1, 2, 3, 4, 5, 6, 7);
    const Pack xy0 = __builtin_shufflevector(row[0], row[1], 0, 4, 8, 12, 1, 5, 9, 13);
    const Pack xy4 = __builtin_shufflevector(row[2], row[3], 0, 4, 8, 12, 1, 5, 9, 13);
    const Pack z0 = __builtin_shufflevector(row[0], row[1], 2, 6, 10, 14, 2, 6, 10, 14);
    const Pack z4 = __builtin_shufflevector(row[2], row[3], 2, 6, 10, 14, 2, 6, 10, 14);
    x[0] = __builtin_shufflevector(xy0, xy4, 0, 1, 2, 3, 8, 9, 10, 11);
    x[1] = __builtin_shufflevector(xy0, xy4, 4, 5, 6, 7, 12, 13, 14, 15);
    x[2] = __builtin_shufflevector(z0, z4, 0, 1, 2, 3, 8, 9, 10, 11);
  }
}

// Rows [x y z z] of the lanes l and l + 1 of eight.
template <int l, class Pack>
[[gnu::always_inline]] inline Pack two_rows(const Pack (&f)[3]) {
  const Pack xy = __builtin_shufflevector(f[0], f[1], l, 8 + l, l, l, l + 1, 9 + l, l, l);
  return __builtin_shufflevector(xy, f[2], 0, 1, 8 + l, 8 + l, 4, 5, 9 + l, 9 + l);
}

// To [lane][x y z and anything].
template <class Pack>
[[gnu::always_inline]] inline void store_doubles(double* to, const Pack (&f)[3]) {
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
    store(to, two_rows<0>(f));
    store(to + 8, two_rows<2>(f));
    store(to + 16, two_rows<4>(f));
    store(to + 24, two_rows<6>(f));
  }
}

// Lanes of two registers as one, the first one's first.
template <class Pack, class Half, std::size_t... k>
[[gnu::always_inline]] inline Pack join(const Half& low, const Half& high,
                                        std::index_sequence<k...>) {
  return __builtin_shufflevector(low, high, k...);
}

// What is added to a double corner for singles: the half registers that hold it.
template <class Pack>
struct Halves {
  static constexpr int width = pack_width<Pack> > 1 ? pack_width<Pack> / 2 : 1;
  using Double = PackOf<double, width>;
  using Single = PackOf<float, width>;
  Double low[3], high[3];

  [[gnu::always_inline]] Halves(const double* u, const std::int32_t* node, bool is_row) {
    gather_corner(u, node, is_row, low);
    if constexpr (pack_width < Pack >> 1) gather_corner(u, node + width, is_row, high);
  }

  // Differences to `origin`, rounded.
  [[gnu::always_inline]] void minus(const Halves& origin, Pack (&x)[3]) const {
    for (int i = 0; i < 3; ++i) {
      if constexpr (pack_width < Pack >> 1)
        x[i] = join<Pack>(__builtin_convertvector(low[i] - origin.low[i], Single),
                          __builtin_convertvector(high[i] - origin.high[i], Single),
                          std::make_index_sequence<pack_width<Pack>>{});
      else
        x[i] = Pack{static_cast<float>(low[i] - origin.low[i])};
    }
  }
};

// Displacements of all corners of a group; corner[corner][lane].
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_corners(const double* u, const std::int32_t* corner,
                                                  bool is_row, Pack (&x)[n][3]) {
  if constexpr (sizeof(RealOf<Pack>) == sizeof(double)) {
    for (int a = 0; a < n; ++a) gather_corner(u, corner + a * block_lanes<Pack>, is_row, x[a]);
  } else {
    const Halves<Pack> origin(u, corner, is_row);
    for (int i = 0; i < 3; ++i) x[0][i] = Pack{};
    for (int a = 1; a < n; ++a)
      Halves<Pack>(u, corner + a * block_lanes<Pack>, is_row).minus(origin, x[a]);
  }
}

// Lanes 4 r / width … of [lane][x y z 0], as many as fit into the r-th register.
template <int r, class Pack, std::size_t... k>
[[gnu::always_inline]] inline Pack rows_of_four(const Pack (&f)[3], std::index_sequence<k...>) {
  constexpr std::size_t width = sizeof...(k), first = r * width / 4;
  const Pack xy = __builtin_shufflevector(f[0], f[1], (first + k / 4 + (k % 2) * width)...);
  const Pack z0 = __builtin_shufflevector(f[2], Pack{}, (first + k / 4 + (k % 2) * width)...);
  return __builtin_shufflevector(xy, z0, (k % 4 < 2 ? k : width + k - 2)...);
}

template <class Pack, int... r>
[[gnu::always_inline]] inline void store_singles(float* to, const Pack (&f)[3],
                                                 std::integer_sequence<int, r...>) {
  constexpr int width = pack_width<Pack>;
  (store(to + r * width, rows_of_four<r>(f, std::make_index_sequence<width>{})), ...);
}

// To [lane][x y z and anything].
template <class Pack>
[[gnu::always_inline]] inline void store_corner(RealOf<Pack>* to, const Pack (&f)[3]) {
  if constexpr (sizeof(RealOf<Pack>) == sizeof(double)) {
    store_doubles(to, f);
  } else if constexpr (pack_width<Pack> == 1) {
    for (int i = 0; i < 3; ++i) to[i] = f[i][0];
    to[3] = 0;
  } else {
    store_singles(to, f, std::make_integer_sequence<int, 4>{});
  }
}

// Lanes of any precision to doubles.
template <class Pack>
[[gnu::always_inline]] inline void store_in_double(double* to, const Pack& x) {
  RealOf<Pack> lane[pack_width<Pack>];
  store(lane, x);
  for (int l = 0; l < pack_width<Pack>; ++l) to[l] = lane[l];
}

template <class Pack>
[[gnu::always_inline]] inline Pack load_in_double(const double* from) {
  return load<Pack>(from);
}
template <class Pack>
[[gnu::always_inline]] inline Pack load_in_double(const float* from) {
  if constexpr (pack_width<Pack> == 1)
    return *from;
  else
    return __builtin_convertvector(load<PackOf<float, pack_width<Pack>>>(from), Pack);
}

// Numbers that are added to sums in one go.
template <class Pack>
inline constexpr int add_width = sizeof(Pack) < 2 * sizeof(double)
                                     ? 1
                                     : static_cast<int>(sizeof(Pack) / sizeof(double));

// sum[0 … n) += from[0 … n)
template <int width, int n, class Real>
[[gnu::always_inline]] inline void add_numbers(const Real* from, double* sum) {
  using Part = PackOf<double, width>;
#pragma GCC unroll 8
  for (int j = 0; j < n; j += width)
    store(sum + j, Part(load<Part>(sum + j) + load_in_double<Part>(from + j)));
}

// Adds the forces of a group's corners to sum[4 * target], one element after the other: so a node's
// sum has the order of its elements, whatever the pack.
template <class Pack, int n>
[[gnu::always_inline]] inline void add_corners(const Pack (&f)[n][3], const std::int32_t* target,
                                               std::uint32_t row, double* sum) {
  constexpr int width = pack_width<Pack>;
  alignas(64) RealOf<Pack> force[n][width][4];
  for (int a = 0; a < n; ++a) store_corner(&force[a][0][0], f[a]);
  if (row != no_row) {
    for (int k = 0; k < n; ++k) {
      const int a = corner_of_row(row, k);
      add_numbers<add_width<Pack>, 4 * width>(
          &force[a][0][0], sum + 4 * std::int64_t{target[a * block_lanes<Pack>]});
    }
    return;
  }
#pragma GCC unroll 16
  for (int lane = 0; lane < width; ++lane)
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a)
      add_numbers<(add_width<Pack> < 4 ? add_width<Pack> : 4), 4>(
          force[a][lane], sum + 4 * std::int64_t{target[a * block_lanes<Pack> + lane]});
}

}  // namespace trocar
