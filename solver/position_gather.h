// Reference positions in single precision from memory to lanes in registers: [x y z 0] of each
// node, four nodes in a register of the widest kind.
#pragma once

#include <cstdint>

#include "solver/block_data.h"
#include "solver/row_order.h"

namespace trocar {

[[gnu::always_inline]] inline PackOf<float, 4> load_position(const float* X, std::int32_t node) {
  return load<PackOf<float, 4>>(X + 4 * std::int64_t{node});
}

// [x y z 0] of the lanes k, k + 4, ... of a pack.
template <class Pack>
[[gnu::always_inline]] inline Pack load_every_fourth(const float* X, const std::int32_t* node) {
  if constexpr (pack_width<Pack> == 4) {
    return load_position(X, node[0]);
  } else {
    static_assert(pack_width<Pack> == 8);
    return __builtin_shufflevector(load_position(X, node[0]), load_position(X, node[4]), 0, 1, 2, 3,
                                   4, 5, 6, 7);
  }
}

// Of nodes anywhere, as many as the pack has lanes.
template <class Pack>
[[gnu::always_inline]] inline void gather_positions_of(const float* X, const std::int32_t* node,
                                                       Pack (&x)[3]) {
  Pack row[4];
  for (int k = 0; k < 4; ++k) row[k] = load_every_fourth<Pack>(X, node + k);
  if constexpr (pack_width<Pack> == 4) {
    const Pack xy0 = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
    const Pack xy2 = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
    const Pack z0 = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
    const Pack z2 = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
    x[0] = __builtin_shufflevector(xy0, xy2, 0, 1, 4, 5);
    x[1] = __builtin_shufflevector(xy0, xy2, 2, 3, 6, 7);
    x[2] = __builtin_shufflevector(z0, z2, 0, 1, 4, 5);
  } else {
    const Pack xy0 = __builtin_shufflevector(row[0], row[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const Pack xy2 = __builtin_shufflevector(row[2], row[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const Pack z0 = __builtin_shufflevector(row[0], row[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const Pack z2 = __builtin_shufflevector(row[2], row[3], 2, 10, 3, 11, 6, 14, 7, 15);
    x[0] = __builtin_shufflevector(xy0, xy2, 0, 1, 8, 9, 4, 5, 12, 13);
    x[1] = __builtin_shufflevector(xy0, xy2, 2, 3, 10, 11, 6, 7, 14, 15);
    x[2] = __builtin_shufflevector(z0, z2, 0, 1, 8, 9, 4, 5, 12, 13);
  }
}

// Four nodes one behind the other, of sixteen numbers.
template <class Pack>
[[gnu::always_inline]] inline Pack load_four(const float* X, const std::int32_t* node) {
  Pack x = _mm512_castps128_ps512(load_position(X, node[0]));
  x = _mm512_mask_insertf32x4(x, 0xFFFF, x, load_position(X, node[1]), 1);
  x = _mm512_mask_insertf32x4(x, 0xFFFF, x, load_position(X, node[2]), 2);
  return _mm512_mask_insertf32x4(x, 0xFFFF, x, load_position(X, node[3]), 3);
}

// Half of the lanes of sixteen: [x of eight, y of eight], [z of eight, twice].
template <class Pack>
struct EightPositions {
  Pack xy, z;

  [[gnu::always_inline]] void take(const Pack& low, const Pack& high) {
    xy = __builtin_shufflevector(low, high, 0, 4, 8, 12, 16, 20, 24, 28, 1, 5, 9, 13, 17, 21, 25,
                                 29);
    z = __builtin_shufflevector(low, high, 2, 6, 10, 14, 18, 22, 26, 30, 2, 6, 10, 14, 18, 22, 26,
                                30);
  }
  [[gnu::always_inline]] void take_row(const float* from) {
    take(load<Pack>(from), load<Pack>(from + pack_width<Pack>));
  }
};

// Eight numbers of each register, from the first on.
template <int first, class Pack>
[[gnu::always_inline]] inline Pack join_halves(const Pack& low, const Pack& high) {
  constexpr int f = first, g = first + 16;
  return __builtin_shufflevector(low, high, f, f + 1, f + 2, f + 3, f + 4, f + 5, f + 6, f + 7, g,
                                 g + 1, g + 2, g + 3, g + 4, g + 5, g + 6, g + 7);
}

template <class Pack>
[[gnu::always_inline]] inline void join_positions(const EightPositions<Pack>& low,
                                                  const EightPositions<Pack>& high, Pack (&x)[3]) {
  x[0] = join_halves<0>(low.xy, high.xy);
  x[1] = join_halves<row_lanes>(low.xy, high.xy);
  x[2] = join_halves<0>(low.z, high.z);
}

// Eight lanes of sixteen, at all corners.
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_eight(const float* X, const std::int32_t* corner,
                                                std::uint32_t row, EightPositions<Pack> (&x)[n]) {
  constexpr int lanes = pack_width<Pack>;
  if (is_row(row)) {
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a) x[a].take_row(X + 4 * std::int64_t{corner[a * lanes]});
    return;
  }
#pragma GCC unroll 8
  for (int a = 0; a < n; ++a) {
    const std::int32_t* const node = corner + a * lanes;
    x[a].take(load_four<Pack>(X, node), load_four<Pack>(X, node + 4));
  }
}

// Positions of all corners of a group; corner[corner][lane], row of its lanes.
template <class Pack, int n>
[[gnu::always_inline]] inline void gather_positions(const float* X, const std::int32_t* corner,
                                                    const std::uint32_t* row, Pack (&x)[n][3]) {
  constexpr int width = pack_width<Pack>, lanes = lanes_of_block<float>;
  if constexpr (width == 1) {
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i) x[a][i] = Pack{X[4 * std::int64_t{corner[a * lanes]} + i]};
  } else if constexpr (width == 16) {
    EightPositions<Pack> low[n], high[n];
    if (is_row(row[0]) && is_row(row[1])) {
#pragma GCC unroll 8
      for (int a = 0; a < n; ++a) {
        low[a].take_row(X + 4 * std::int64_t{corner[a * lanes]});
        high[a].take_row(X + 4 * std::int64_t{corner[a * lanes + row_lanes]});
        join_positions(low[a], high[a], x[a]);
      }
      return;
    }
    gather_eight(X, corner, row[0], low);
    gather_eight(X, corner + row_lanes, row[1], high);
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a) join_positions(low[a], high[a], x[a]);
  } else {
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a) gather_positions_of(X, corner + a * lanes, x[a]);
  }
}

}  // namespace trocar
