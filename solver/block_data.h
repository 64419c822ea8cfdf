// How an element's constants lie in a block, and how kernels read them: [value][lane], first those
// of the material (K V and mu V [J], so that stresses come out times the volume, then what
// material_<name>.h says), then those of element_<type>.h.
#pragma once

#include "solver/pack.h"

namespace trocar {

// Lanes of a block: one cache line, and one register of the widest kind, holds one value of
// several elements.
template <class Real>
inline constexpr int lanes_of_block = static_cast<int>(64 / sizeof(Real));
template <class Pack>
inline constexpr int block_lanes = lanes_of_block<RealOf<Pack>>;

inline constexpr int value_K_V = 0;
inline constexpr int value_mu_V = 1;

// One value of the lanes from `at` on.
template <class Pack>
struct BlockValues {
  const RealOf<Pack>* at;
  [[gnu::always_inline]] Pack operator()(std::int64_t value) const {
    return load<Pack>(at + value * block_lanes<Pack>);
  }
};

}  // namespace trocar
