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
  else if constexpr (pack_width<Pack> == 8)
    return _mm512_maskz_cvtps_pd(0xFF, load<PackOf<float, 8>>(from));  // in one, not in two halves
  else if constexpr (pack_width<Pack> == 4)
    return _mm256_cvtps_pd(load<PackOf<float, 4>>(from));  // likewise
  else
    return __builtin_convertvector(load<PackOf<float, pack_width<Pack>>>(from), Pack);
}

template <class Pack>
[[gnu::always_inline]] inline Pack load_rounded(const double* from) {
  RealOf<Pack> lane[pack_width<Pack>];
  for (int l = 0; l < pack_width<Pack>; ++l) lane[l] = static_cast<RealOf<Pack>>(from[l]);
  return load<Pack>(lane);
}

// Doubles rounded.
template <class Pack>
[[gnu::always_inline]] inline PackOf<float, pack_width<Pack>> in_single(const Pack& x) {
  if constexpr (pack_width<Pack> == 8)
    return _mm512_maskz_cvtpd_ps(0xFF, x);
  else
    return __builtin_convertvector(x, PackOf<float, pack_width<Pack>>);
}

}  // namespace trocar
