// Packs: one value of several elements in a vector register, or of one element in a double. GCC's
// vector types have the arithmetic; here is what they lack. Everything is a template on the pack
// type, so that no function is shared between instruction sets.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace trocar {

template <int width>
struct PackOf;
template <>
struct PackOf<1> {
  using Real = double;
  using Bits = std::uint64_t;
};
template <>
struct PackOf<2> {
  using Real = double __attribute__((vector_size(16)));
  using Bits = std::uint64_t __attribute__((vector_size(16)));
};
template <>
struct PackOf<4> {
  using Real = double __attribute__((vector_size(32)));
  using Bits = std::uint64_t __attribute__((vector_size(32)));
};
template <>
struct PackOf<8> {
  using Real = double __attribute__((vector_size(64)));
  using Bits = std::uint64_t __attribute__((vector_size(64)));
};

template <class Pack>
inline constexpr int pack_width = static_cast<int>(sizeof(Pack) / sizeof(double));
template <class Pack>
using PackBits = typename PackOf<pack_width<Pack>>::Bits;

template <class Pack>
[[gnu::always_inline]] inline Pack load(const double* from) {
  Pack x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}

template <class Pack>
[[gnu::always_inline]] inline void store(double* to, const Pack& x) {
  __builtin_memcpy(to, &x, sizeof x);
}

template <class Pack>
[[gnu::always_inline]] inline Pack square_root(const Pack& x) {
  if constexpr (pack_width<Pack> == 8)
    return _mm512_maskz_sqrt_pd(0xFF, x);
  else if constexpr (pack_width<Pack> == 4)
    return _mm256_sqrt_pd(x);
  else if constexpr (pack_width<Pack> == 2)
    return _mm_sqrt_pd(x);
  else
    return __builtin_sqrt(x);
}

template <class Pack>
[[gnu::always_inline]] inline Pack larger(const Pack& a, const Pack& b) {
  return a > b ? a : b;
}

template <class Pack>
[[gnu::always_inline]] inline Pack absolute(const Pack& x) {
  return __builtin_bit_cast(Pack, __builtin_bit_cast(PackBits<Pack>, x) & (~0ULL >> 1));
}

}  // namespace trocar
