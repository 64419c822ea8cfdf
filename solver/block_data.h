// How an element's constants lie in a block, and how kernels read them: [value][lane], first
// lambda V and mu V [J] (so that stresses come out times the volume), then what element_<type>.h
// says.
#pragma once

#include "solver/pack.h"

namespace trocar {

// Lanes of a block: one vector register holds one value of several elements.
inline constexpr int block_lanes = 8;

inline constexpr int value_lambda_V = 0;
inline constexpr int value_mu_V = 1;
inline constexpr int first_element_value = 2;
inline constexpr int max_element_values = 33;  // hex8

// One value of the lanes from `at` on.
template <class Pack>
struct BlockValues {
  const double* at;
  [[gnu::always_inline]] Pack operator()(int value) const {
    return load<Pack>(at + value * block_lanes);
  }
};

}  // namespace trocar
