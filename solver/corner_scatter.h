// From lanes in registers to sums in memory: corner forces are added element after element, so that
// a node's sum has the order of its elements, whatever the pack.
#pragma once

#include <cstdint>
#include <utility>

#include "solver/block_data.h"
#include "solver/row_order.h"

namespace trocar {

// x and y of half of the lanes in turn.
template <int half, class Pack, std::size_t... k>
[[gnu::always_inline]] inline Pack x_and_y(const Pack& x, const Pack& y,
                                           std::index_sequence<k...>) {
  constexpr std::size_t width = sizeof...(k), first = half * width / 2;
  return __builtin_shufflevector(x, y, (first + k / 2 + (k % 2) * width)...);
}
// Rows [x y z z] of a quarter of the lanes, from [x y] of the half that it is in.
template <int part, class Pack, std::size_t... k>
[[gnu::always_inline]] inline Pack rows_of_quarter(const Pack& xy, const Pack& z,
                                                   std::index_sequence<k...>) {
  constexpr std::size_t width = sizeof...(k), lane = part * width / 4;
  return __builtin_shufflevector(
      xy, z, (k % 4 < 2 ? (part % 2) * width / 2 + 2 * (k / 4) + k % 4 : width + lane + k / 4)...);
}

// The rows [x y z and anything] of half of the lanes.
template <int half, class Pack>
[[gnu::always_inline]] inline void rows_of_half(const Pack (&f)[3], Pack (&row)[2]) {
  using Numbers = std::make_index_sequence<pack_width<Pack>>;
  const Pack xy = x_and_y<half>(f[0], f[1], Numbers{});
  row[0] = rows_of_quarter<2 * half>(xy, f[2], Numbers{});
  row[1] = rows_of_quarter<2 * half + 1>(xy, f[2], Numbers{});
}

template <class Pack>
[[gnu::always_inline]] inline void store_rows(RealOf<Pack>* to, const Pack (&f)[3]) {
  constexpr int width = pack_width<Pack>;
  Pack low[2], high[2];
  rows_of_half<0>(f, low);
  rows_of_half<1>(f, high);
  for (int k = 0; k < 2; ++k) store(to + k * width, low[k]);
  for (int k = 0; k < 2; ++k) store(to + (k + 2) * width, high[k]);
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
    store_rows(to, f);
  }
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
    store_rows(to, f);
  }
}

// Four numbers of a register, the k-th.
template <int k, class Pack>
[[gnu::always_inline]] inline auto quarter(const Pack& x) {
  return __builtin_shufflevector(x, x, 4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3);
}

// sum[0 … n) += from[0 … n), width of them in one go.
template <int width, int n, class Real>
[[gnu::always_inline]] inline void add_numbers(const Real* from, Real* sum) {
  using Part = PackOf<Real, width>;
#pragma GCC unroll 8
  for (int j = 0; j < n; j += width)
    store(sum + j, Part(load<Part>(sum + j) + load<Part>(from + j)));
}

// Of registers of `width` numbers, the last four of `before` and all but the last four of `after`.
template <class Part, std::size_t... k>
[[gnu::always_inline]] inline Part a_node_later(const Part& before, const Part& after,
                                                std::index_sequence<k...>) {
  return __builtin_shufflevector(before, after, (sizeof...(k) - 4 + k)...);
}
// A register whose last four numbers are these; GCC shuffles to the widest ones over the stack.
template <class Part, std::size_t... k>
[[gnu::always_inline]] inline Part last_in(const PackOf<RealOf<Part>, 4>& x,
                                           std::index_sequence<k...>) {
  if constexpr (sizeof...(k) == 16)
    return _mm512_maskz_broadcast_f32x4(0xFFFF, x);
  else if constexpr (sizeof(Part) == 64)
    return _mm512_maskz_broadcast_f64x4(0xFF, x);
  else
    return __builtin_shufflevector(x, x, (k % 4)...);
}
// The last four numbers.
template <class Part, std::size_t... k>
[[gnu::always_inline]] inline auto last_node(const Part& x, std::index_sequence<k...>) {
  return __builtin_shufflevector(x, x, (pack_width<Part> - 4 + k)...);
}

// Of n numbers first(j), j = 0, a register's width …: sum[4 + j …] += first(j) and then sum[j …] +=
// second(j). What is added first stays in registers: read back from memory, shifted by a node, it
// would have to leave the store buffer first (7.5 instead of 4.2 ns a hexahedron).
template <class Part, int n, class First, class Second>
[[gnu::always_inline]] inline void add_neighbours(const First& first, const Second& second,
                                                  RealOf<Part>* sum) {
  constexpr int width = pack_width<Part>;
  using Quad = PackOf<RealOf<Part>, 4>;
  Part before = last_in<Part>(load<Quad>(sum), std::make_index_sequence<width>{});
#pragma GCC unroll 8
  for (int j = 0; j < n; j += width) {
    const Part added = load<Part>(sum + 4 + j) + first(j);
    const Part shifted = a_node_later(before, added, std::make_index_sequence<width>{});
    store(sum + j, Part(shifted + second(j)));
    before = added;
  }
  store(sum + n, last_node(before, std::make_index_sequence<4>{}));
}

// Numbers of a row of at most eight lanes; as many as are added to sums in one go.
template <class Pack>
inline constexpr int row_numbers = 4 *
                                   (pack_width < Pack >> row_lanes ? row_lanes : pack_width<Pack>);

// Adds two corners of a row from `lane` on, a first; force[corner][lane][x y z 0].
template <class Pack, int n>
[[gnu::always_inline]] inline void add_two(const RealOf<Pack> (&force)[n][pack_width<Pack>][4],
                                           int lane, const std::int32_t* target, int a, int b,
                                           RealOf<Pack>* sum) {
  constexpr int numbers = row_numbers<Pack>, width = pack_width<Pack>;
  const std::int64_t to_a = target[a * block_lanes<Pack>], to_b = target[b * block_lanes<Pack>];
  const RealOf<Pack>*const from_a = &force[a][lane][0], *const from_b = &force[b][lane][0];
  if constexpr (width >= 8) {
    if (to_a - to_b == 1) {
      add_neighbours<Pack, numbers>([&](int j) { return load<Pack>(from_a + j); },
                                    [&](int j) { return load<Pack>(from_b + j); }, sum + 4 * to_b);
      return;
    }
  }
  add_numbers<width, numbers>(from_a, sum + 4 * to_a);
  add_numbers<width, numbers>(from_b, sum + 4 * to_b);
}

// Corner after corner of a row.
template <class Pack, int n>
[[gnu::always_inline]] inline void add_row(const RealOf<Pack> (&force)[n][pack_width<Pack>][4],
                                           int lane, const std::int32_t* target, std::uint32_t row,
                                           RealOf<Pack>* sum) {
  for (int k = 0; k + 1 < n; k += 2)
    add_two<Pack>(force, lane, target, corner_of_row(row, k), corner_of_row(row, k + 1), sum);
  if constexpr (n % 2 != 0) {
    const int a = corner_of_row(row, n - 1);
    add_numbers<pack_width<Pack>, row_numbers<Pack>>(
        &force[a][lane][0], sum + 4 * std::int64_t{target[a * block_lanes<Pack>]});
  }
}

// Of hexahedra of a box: corners are known beforehand.
template <class Pack>
[[gnu::always_inline]] inline void add_box_row(const RealOf<Pack> (&force)[8][pack_width<Pack>][4],
                                               int lane, const std::int32_t* target,
                                               RealOf<Pack>* sum) {
#pragma GCC unroll 4
  for (int k = 0; k < 8; k += 2)
    add_two<Pack>(force, lane, target, corner_of_row(box_row, k), corner_of_row(box_row, k + 1),
                  sum);
}

// The same of the k-th eight lanes, which are still in registers, without a detour through memory,
// where neighbours follow each other.
template <int k, class Pack>
[[gnu::always_inline]] inline void add_box_row(const Pack (&f)[8][3], const std::int32_t* target,
                                               RealOf<Pack>* sum) {
  constexpr int width = pack_width<Pack>, n_registers = row_numbers<Pack> / width;
  const auto rows = [](const Pack(&of)[3], Pack(&row)[4]) __attribute__((always_inline)) {
    Pack half[2][2];
    rows_of_half<k>(of, half[0]);
    if constexpr (n_registers > 2) rows_of_half<1>(of, half[1]);
    for (int j = 0; j < n_registers; ++j) row[j] = half[j / 2][j % 2];
  };
#pragma GCC unroll 4
  for (int pair = 0; pair < 8; pair += 2) {
    const int a = corner_of_row(box_row, pair), b = corner_of_row(box_row, pair + 1);
    Pack first[4], second[4];
    rows(f[a], first);
    rows(f[b], second);
    add_neighbours<Pack, row_numbers<Pack>>(
        [&](int j) __attribute__((always_inline)) { return first[j / width]; },
        [&](int j) __attribute__((always_inline)) { return second[j / width]; },
        sum + 4 * std::int64_t{target[b * block_lanes<Pack> + k * row_lanes]});
  }
}

// Whether it may, of lanes that stand in a row of a box.
template <class Pack>
[[gnu::always_inline]] inline bool follow_each_other(const std::int32_t* target) {
  std::int32_t apart = 0;
#pragma GCC unroll 4
  for (int k = 0; k < 8; k += 2)
    apart |= target[corner_of_row(box_row, k) * block_lanes<Pack>] -
             target[corner_of_row(box_row, k + 1) * block_lanes<Pack>] - 1;
  return apart == 0;
}

// Element after element of at most eight lanes.
template <class Pack, int n>
[[gnu::always_inline]] inline void add_lanes(const RealOf<Pack> (&force)[n][pack_width<Pack>][4],
                                             int first, const std::int32_t* target,
                                             RealOf<Pack>* sum) {
  constexpr int width = pack_width < Pack >> row_lanes ? row_lanes : pack_width<Pack>;
#pragma GCC unroll 8
  for (int lane = 0; lane < width; ++lane)
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a) {
      const auto at = static_cast<std::uint32_t>(target[a * block_lanes<Pack> + lane]);
      add_numbers<(pack_width<Pack> < 4 ? pack_width<Pack> : 4), 4>(force[a][first + lane],
                                                                    sum + 4 * std::size_t{at});
    }
}

// The same of half a register's lanes, from registers: stores to be read back soon are what a step
// waits for most.
template <int half, class Pack, int n, int... r>
[[gnu::always_inline]] inline void add_lanes_of(const Pack (&f)[n][3], const std::int32_t* target,
                                                RealOf<Pack>* sum,
                                                std::integer_sequence<int, r...>) {
  constexpr int width = pack_width<Pack>, in_row = width / 4;
  Pack row[n][2];
#pragma GCC unroll 8
  for (int a = 0; a < n; ++a) rows_of_half<half>(f[a], row[a]);
  const auto add = [&](int a, int lane, const auto& x) __attribute__((always_inline)) {
    const auto at = static_cast<std::uint32_t>(target[a * block_lanes<Pack> + lane]);
    RealOf<Pack>* const to = sum + 4 * std::size_t{at};
    using Quad = PackOf<RealOf<Pack>, 4>;
    store(to, Quad(load<Quad>(to) + x));
  };
  const auto add_row = [&]<int k>(std::integral_constant<int, k>, int first)
      __attribute__((always_inline)) {
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a)
      add(a, half * width / 2 + in_row * first + k, quarter<k>(row[a][first]));
  };
#pragma GCC unroll 2
  for (int first = 0; first < 2; ++first) (add_row(std::integral_constant<int, r>{}, first), ...);
}

// The k-th eight lanes: a row of a box or anywhere.
template <int k, class Pack, int n>
[[gnu::always_inline]] inline void add_eight(const Pack (&f)[n][3], const std::int32_t* target,
                                             std::uint32_t row, RealOf<Pack>* sum) {
  using Quarters = std::make_integer_sequence<int, pack_width<Pack> / 4>;
  if constexpr (n == 8)
    if (row == box_row) {
      add_box_row<k>(f, target, sum);
      return;
    }
  add_lanes_of<k>(f, target, sum, Quarters{});
  if constexpr (pack_width<Pack> == row_lanes) add_lanes_of<1>(f, target, sum, Quarters{});
}

template <class Pack, int n>
[[gnu::always_inline]] inline bool may_stay_in_registers(const std::int32_t* target,
                                                         const std::uint32_t* row) {
#pragma GCC unroll 2
  for (int k = 0; k < pack_width<Pack> / row_lanes; ++k)
    if (is_row(row[k]) &&
        (n != 8 || row[k] != box_row || !follow_each_other<Pack>(target + k * row_lanes)))
      return false;
  return true;
}

// Adds the forces of a group's corners to sum[4 * target].
template <class Pack, int n>
[[gnu::always_inline]] inline void add_corners(const Pack (&f)[n][3], const std::int32_t* target,
                                               const std::uint32_t* row, RealOf<Pack>* sum) {
  constexpr int width = pack_width<Pack>;
  if constexpr (sizeof(Pack) == 64)
    if (may_stay_in_registers<Pack, n>(target, row)) {
      add_eight<0>(f, target, row[0], sum);
      if constexpr (width > row_lanes) add_eight<1>(f, target, row[1], sum);
      return;
    }
  alignas(64) RealOf<Pack> force[n][width][4];
#pragma GCC unroll 8
  for (int a = 0; a < n; ++a) store_corner(&force[a][0][0], f[a]);
  // Read back where it is used: or every store is made twice, the second one to copies for the
  // single lanes.
  asm volatile("" ::: "memory");
  for (int first = 0; first < width; first += row_lanes) {
    const std::uint32_t group_row = row[first / row_lanes];
    if constexpr (n == 8)
      if (group_row == box_row) {
        add_box_row<Pack>(force, first, target + first, sum);
        continue;
      }
    if (is_row(group_row))
      add_row<Pack>(force, first, target + first, group_row, sum);
    else
      add_lanes<Pack>(force, first, target + first, sum);
  }
}

}  // namespace trocar
