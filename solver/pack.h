// Packs: one value of several elements in a vector register, or of one element alone. GCC's vector
// types have the arithmetic; here is what they lack. Everything is a template on the pack type, so
// that no function is shared between instruction sets: no two of them have a pack type in common.
#pragma once

#include <immintrin.h>

#include <cstdint>
#include <type_traits>

namespace trocar {

// A single float is a vector of one, so that constants don't widen it to double.
template <class Real, int width>
struct PackType;
template <>
struct PackType<float, 1> {
  using type = float __attribute__((vector_size(4)));
};
template <>
struct PackType<float, 2> {
  using type = float __attribute__((vector_size(8)));
};
template <>
struct PackType<float, 4> {
  using type = float __attribute__((vector_size(16)));
};
template <>
struct PackType<float, 8> {
  using type = float __attribute__((vector_size(32)));
};
template <>
struct PackType<float, 16> {
  using type = float __attribute__((vector_size(64)));
};
template <>
struct PackType<double, 1> {
  using type = double;
};
template <>
struct PackType<double, 2> {
  using type = double __attribute__((vector_size(16)));
};
template <>
struct PackType<double, 4> {
  using type = double __attribute__((vector_size(32)));
};
template <>
struct PackType<double, 8> {
  using type = double __attribute__((vector_size(64)));
};
template <>
struct PackType<std::uint32_t, 1> {
  using type = std::uint32_t __attribute__((vector_size(4)));
};
template <>
struct PackType<std::uint32_t, 2> {
  using type = std::uint32_t __attribute__((vector_size(8)));
};
template <>
struct PackType<std::uint32_t, 4> {
  using type = std::uint32_t __attribute__((vector_size(16)));
};
template <>
struct PackType<std::uint32_t, 8> {
  using type = std::uint32_t __attribute__((vector_size(32)));
};
template <>
struct PackType<std::uint32_t, 16> {
  using type = std::uint32_t __attribute__((vector_size(64)));
};
template <>
struct PackType<std::uint64_t, 1> {
  using type = std::uint64_t;
};
template <>
struct PackType<std::uint64_t, 2> {
  using type = std::uint64_t __attribute__((vector_size(16)));
};
template <>
struct PackType<std::uint64_t, 4> {
  using type = std::uint64_t __attribute__((vector_size(32)));
};
template <>
struct PackType<std::uint64_t, 8> {
  using type = std::uint64_t __attribute__((vector_size(64)));
};
template <class Real, int width>
using PackOf = typename PackType<Real, width>::type;

template <class Pack>
struct PackReal {
  using type = std::remove_cvref_t<decltype(Pack{}[0])>;
};
template <>
struct PackReal<double> {
  using type = double;
};
template <class Pack>
using RealOf = typename PackReal<Pack>::type;

template <class Pack>
inline constexpr int pack_width = static_cast<int>(sizeof(Pack) / sizeof(RealOf<Pack>));
// Unsigned integers of the same size, lane by lane.
template <class Pack>
using BitsOf = PackOf<std::conditional_t<sizeof(RealOf<Pack>) == 8, std::uint64_t, std::uint32_t>,
                      pack_width<Pack>>;

// A constant that float can't hold exactly, rounded to the pack's precision.
template <class Pack>
[[gnu::always_inline]] constexpr RealOf<Pack> real(double x) {
  return static_cast<RealOf<Pack>>(x);
}

template <class Pack>
[[gnu::always_inline]] inline Pack load(const RealOf<Pack>* from) {
  Pack x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}

template <class Pack>
[[gnu::always_inline]] inline void store(RealOf<Pack>* to, const Pack& x) {
  __builtin_memcpy(to, &x, sizeof x);
}

// x in every lane. Zero is taken away, not added: x - 0 is x and costs nothing, but 0 + -0 is 0, so
// that sum would be computed.
template <class Pack>
[[gnu::always_inline]] inline Pack splat(RealOf<Pack> x) {
  return x - Pack{};
}

template <class Pack>
[[gnu::always_inline]] inline Pack square_root(const Pack& x) {
  if constexpr (std::is_same_v<Pack, double>)
    return __builtin_sqrt(x);
  else if constexpr (sizeof(Pack) == sizeof(float))
    return Pack{__builtin_sqrtf(x[0])};
  else if constexpr (std::is_same_v<RealOf<Pack>, double>) {
    if constexpr (pack_width<Pack> == 8)
      return _mm512_maskz_sqrt_pd(0xFF, x);
    else if constexpr (pack_width<Pack> == 4)
      return _mm256_sqrt_pd(x);
    else
      return _mm_sqrt_pd(x);
  } else {
    if constexpr (pack_width<Pack> == 16)
      return _mm512_maskz_sqrt_ps(0xFFFF, x);
    else if constexpr (pack_width<Pack> == 8)
      return _mm256_sqrt_ps(x);
    else
      return _mm_sqrt_ps(x);
  }
}

template <class Pack>
[[gnu::always_inline]] inline Pack larger(const Pack& a, const Pack& b) {
  return a > b ? a : b;
}

template <class Pack>
[[gnu::always_inline]] inline Pack absolute(const Pack& x) {
  using Bits = BitsOf<Pack>;
  using Word = std::conditional_t<sizeof(RealOf<Pack>) == 8, std::uint64_t, std::uint32_t>;
  constexpr Word no_sign = static_cast<Word>(~Word{0}) >> 1;
  return __builtin_bit_cast(Pack, __builtin_bit_cast(Bits, x) & no_sign);
}

// Whether the condition holds in any lane; seldom, so that what follows is put aside.
template <class Mask>
[[gnu::always_inline]] inline bool is_any(const Mask& condition) {
  bool is_found = false;
  if constexpr (std::is_same_v<Mask, bool>)
    is_found = condition;
  else if constexpr (sizeof(Mask) == 64)
    is_found = _mm512_test_epi32_mask(__builtin_bit_cast(__m512i, condition),
                                      __builtin_bit_cast(__m512i, condition)) != 0;
  else if constexpr (sizeof(Mask) == 32)
    is_found = _mm256_movemask_epi8(__builtin_bit_cast(__m256i, condition)) != 0;
  else if constexpr (sizeof(Mask) == 16)
    is_found = _mm_movemask_epi8(__builtin_bit_cast(__m128i, condition)) != 0;
  else
    is_found = condition[0] != 0;
  return __builtin_expect(is_found, false);
}

template <class Pack>
[[gnu::always_inline]] inline Pack zero_of(const Pack&) {
  return Pack{} + real<Pack>(0);
}

}  // namespace trocar
