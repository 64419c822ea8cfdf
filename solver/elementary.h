// log(1 + x) and exp(x) - 1 on packs: shifts, + - * / alone, so that every machine gives the same
// bits, and with the digits that small x needs.
#pragma once

#include "solver/pack.h"

namespace trocar {

// Where exponent and mantissa of an IEEE number lie, and how long the series must be.
template <class Real>
struct FloatFormat;
template <>
struct FloatFormat<double> {
  static constexpr int mantissa_bits = 52;
  static constexpr std::uint64_t half_root_bits = 0x3FE6A09E667F3BCD;  // of sqrt(1/2)
  static constexpr std::uint64_t offset = 1024;                        // makes exponents positive
  static constexpr std::uint64_t integer_bits = 0x4330000000000000;    // of 2^52
  static constexpr double integer_one = 0x1p52;
  static constexpr double shift = 0x1.8p52 + 1023;  // adding it rounds to an integer
  static constexpr double ln2_high = 6.93147180369123816490e-01;
  static constexpr double ln2_low = 1.90821492927058770002e-10;
  static constexpr double largest_exponent = 700;  // e^700 is finite
  static constexpr double tiny = 1e-300;
  static constexpr int n_log = 11, n_exp = 13;
};
template <>
struct FloatFormat<float> {
  static constexpr int mantissa_bits = 23;
  static constexpr std::uint32_t half_root_bits = 0x3F3504F3;
  static constexpr std::uint32_t offset = 128;
  static constexpr std::uint32_t integer_bits = 0x4B000000;
  static constexpr float integer_one = 0x1p23F;
  static constexpr float shift = 0x1.8p23F + 127;
  static constexpr float ln2_high = 0.693359375F;
  static constexpr float ln2_low = -2.12194440e-4F;
  static constexpr float largest_exponent = 87;
  static constexpr float tiny = 1e-37F;
  static constexpr int n_log = 5, n_exp = 7;
};

// 1 + x = 2^n (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)), s = f / (2 + f):
//   log(1 + x) = n ln 2 + 2 (s + s^3/3 + s^5/5 + …).
// For n = 0, f = x keeps all digits. Where 1 + x <= 0 (rounding of a vanishing stretch): the least.
template <class Pack>
[[gnu::always_inline]] inline Pack log1p_of(const Pack& x) {
  using Format = FloatFormat<RealOf<Pack>>;
  const Pack tiny = zero_of(x) + Format::tiny;
  Pack a = 1.0 + x;
  a = a < tiny ? tiny : a;
  const BitsOf<Pack> bits = __builtin_bit_cast(BitsOf<Pack>, a);
  const BitsOf<Pack> n_bits =
      (bits + ((Format::offset << Format::mantissa_bits) - Format::half_root_bits)) >>
      Format::mantissa_bits;
  const Pack n = __builtin_bit_cast(Pack, n_bits | Format::integer_bits) -
                 (Format::integer_one + Format::offset);
  const Pack m =
      __builtin_bit_cast(Pack, bits - ((n_bits - Format::offset) << Format::mantissa_bits));
  const Pack f = n == 0.0 ? x : m - 1.0;
  const Pack s = f / (2.0 + f), z = s * s;
  Pack sum = zero_of(x) + real<Pack>(1.0 / (2 * Format::n_log + 1));
#pragma GCC unroll 16
  for (int k = Format::n_log - 1; k >= 1; --k) sum = sum * z + real<Pack>(1.0 / (2 * k + 1));
  const Pack log = 2.0 * s + 2.0 * s * (z * sum);
  return n * Format::ln2_high + (n * Format::ln2_low + log) + (x - x);  // keeps a NaN
}

// x = n ln 2 + r, |r| <= ln 2 / 2: exp(x) - 1 = 2^n (exp(r) - 1) + (2^n - 1).
// Beyond the largest exponent (700, single: 87) it stays what it is there.
template <class Pack>
[[gnu::always_inline]] inline Pack expm1_of(const Pack& x) {
  using Format = FloatFormat<RealOf<Pack>>;
  const Pack most = zero_of(x) + Format::largest_exponent;
  Pack y = x > most ? most : x;
  y = y < -most ? -most : y;
  const Pack shifted = y * real<Pack>(1.44269504088896340736) + Format::shift;
  const Pack n = shifted - Format::shift;
  const Pack power =
      __builtin_bit_cast(Pack, __builtin_bit_cast(BitsOf<Pack>, shifted) << Format::mantissa_bits);
  const Pack r = (y - n * Format::ln2_high) - n * Format::ln2_low;
  // r + r^2/2 (1 + r/3 (1 + r/4 (…)))
  Pack sum = zero_of(x) + 1.0;
#pragma GCC unroll 16
  for (int k = Format::n_exp + 1; k >= 3; --k) sum = 1.0 + sum * r * real<Pack>(1.0 / k);
  const Pack p = r + 0.5 * r * r * sum;
  return power * p + (power - 1.0);
}

}  // namespace trocar
