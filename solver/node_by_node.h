// Three registers, component by component, as three node by node.
#pragma once

#include <utility>

#include "solver/pack.h"

namespace trocar {

// Component of the k-th number, and the lane that it stands in.
constexpr int component_of(std::size_t k) {
  return static_cast<int>(k % 3);
}
constexpr int lane_of(std::size_t k) {
  return static_cast<int>(k / 3);
}

// The numbers from the first on, as many as there are l: of x and y, then of z in their places.
template <std::size_t first, class Pack, std::size_t... l>
[[gnu::always_inline]] inline Pack numbers_from(const Pack (&f)[3], std::index_sequence<l...>) {
  constexpr int n = pack_width<Pack>;
  const Pack xy = __builtin_shufflevector(
      f[0], f[1], (lane_of(first + l) + (component_of(first + l) == 1 ? n : 0))...);
  return __builtin_shufflevector(
      xy, f[2], (component_of(first + l) == 2 ? n + lane_of(first + l) : static_cast<int>(l))...);
}

template <class Pack>
[[gnu::always_inline]] inline void order_by_node(const Pack (&f)[3], Pack (&to)[3]) {
  constexpr int n = pack_width<Pack>;
  if constexpr (n == 8) {
    // Each component in the order in which the three registers take it, then blended: blends cost
    // less than shuffles of two registers.
    const Pack x = __builtin_shufflevector(f[0], f[0], 0, 3, 6, 1, 4, 7, 2, 5);
    const Pack y = __builtin_shufflevector(f[1], f[1], 5, 0, 3, 6, 1, 4, 7, 2);
    const Pack z = __builtin_shufflevector(f[2], f[2], 2, 5, 0, 3, 6, 1, 4, 7);
    const auto blend =
        [](const Pack& of_0, const Pack& of_1, const Pack& of_2) __attribute__((always_inline)) {
      const Pack of_01 = __builtin_shufflevector(of_0, of_1, 0, 9, 2, 3, 12, 5, 6, 15);
      return __builtin_shufflevector(of_01, of_2, 0, 1, 10, 3, 4, 13, 6, 7);
    };
    to[0] = blend(x, y, z);
    to[1] = blend(z, x, y);
    to[2] = blend(y, z, x);
  } else {
    const auto lanes = std::make_index_sequence<n>{};
    to[0] = numbers_from<0>(f, lanes);
    to[1] = numbers_from<n>(f, lanes);
    to[2] = numbers_from<2 * n>(f, lanes);
  }
}

}  // namespace trocar
