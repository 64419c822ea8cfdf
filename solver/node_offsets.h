// Where the numbers of nodes lie in arrays of a few numbers a node.
#pragma once

#include "solver/pack.h"

namespace trocar {

// Node numbers of some lanes, times a stride: what lies before a node, up to 2^32.
template <int n>
[[gnu::always_inline]] inline void multiply(const std::int32_t* node, std::uint32_t stride,
                                            std::uint32_t (&to)[n]) {
  PackOf<std::uint32_t, n> x;
  __builtin_memcpy(&x, node, sizeof x);
  x *= stride;
  __builtin_memcpy(to, &x, sizeof x);
}

}  // namespace trocar
