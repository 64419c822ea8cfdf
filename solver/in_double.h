// Lanes of any precision from and to doubles.
#pragma once

#include "solver/block_data.h"

namespace trocar {

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

}  // namespace trocar
