// q = J^(-2/3) - 1 and 1/J from j = J - 1: without libm, without cancellation at small j, the same
// instructions for any J: relatively exact but for 4e-26 in double and 4e-11 in
// single precision, beside rounding. With |J| in place of J, so that an
// inverted element stays finite; J = 0 gives huge or infinite values, which the watch finds.
#pragma once

#include "solver/pack.h"

namespace trocar {

template <class Pack>
struct Isochoric {
  Pack q, inverse_J;
};

// r ~ a^(-1/3), a > 0, within 3.5 %: the exponent and mantissa bits of a, divided by -3 by shifts
// (b/4 + b/16, times 17/16 and 257/256). The constant, 4/3 of the exponent's bias less 0.0727,
// makes the error symmetric over [1, 8).
template <class Pack>
[[gnu::always_inline]] inline Pack guess_inverse_cube_root(const Pack& a) {
  const BitsOf<Pack> b = __builtin_bit_cast(BitsOf<Pack>, a);
  BitsOf<Pack> third = (b >> 2) + (b >> 4);
  third += third >> 4;
  third += third >> 8;
  if constexpr (sizeof(RealOf<Pack>) == 8)
    return __builtin_bit_cast(Pack, 0x553ED4FF289DD796ULL - third);
  else
    return __builtin_bit_cast(Pack, 0x54A152A3U - third);
}

// With t = 1 - a r^3: a^(-1/3) = r (1 - t)^(-1/3) = r (1 + t/3 + 2 t^2/9 + 14 t^3/81 + …).
template <class Pack>
[[gnu::always_inline]] inline Isochoric<Pack> isochoric(const Pack& j) {
  constexpr auto third = real<Pack>(1.0 / 3), two_ninths = real<Pack>(2.0 / 9);
  const Pack J = 1.0 + j;
  const auto is_inverted = J < 0.0;
  const Pack a = absolute(J);
  const Pack a_less_1 = is_inverted ? -2.0 - j : j;
  Pack r = guess_inverse_cube_root(a);
  // |t| < 0.11, 6e-4, 1.1e-10
  for (int k = 0; k < (sizeof(RealOf<Pack>) == 8 ? 2 : 1); ++k) {
    const Pack t = 1.0 - a * r * (r * r);
    r += r * t * (third + t * two_ninths);
  }
  // The last correction on rho = r - 1: a r^3 - 1 = (a - 1) + a ((1 + rho)^3 - 1).
  Pack rho = r - 1.0;
  const Pack excess = a_less_1 + a * (rho * (3.0 + rho * (3.0 + rho)));
  const Pack correction = r * excess * (third - excess * two_ninths);
  rho -= correction;
  r -= correction;
  const Pack cube = r * r * r;
  return {rho * (2.0 + rho), is_inverted ? -cube : cube};
}

}  // namespace trocar
