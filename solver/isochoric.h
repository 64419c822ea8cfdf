// q = J^(-2/3) - 1 and 1/J from j = J - 1: without libm, without cancellation at small j, the same
// instructions for any J: relatively exact but for 4e-26 in double and 4e-11 in
// single precision, beside rounding. Below a floor J0, 1/J goes on as its Taylor polynomial y of
// second order: the isochoric energy stays finite and twice differentiable through J = 0 and
// rises all the way, so that an inverted element is pushed back.
#pragma once

#include "solver/pack.h"

namespace trocar {

inline constexpr double volume_floor = 0.2;  // J0

// y = (1 + s + s^2) / J0, s = 1 - J/J0, below the floor and 1/J above it.
template <class Pack>
struct Isochoric {
  Pack q;         // y^(2/3) - 1
  Pack inverse;   // -y'/y = -3/2 d ln(1+q)/dJ; 1/J above the floor
  Pack extended;  // 1 - J inverse = 3 s^2 / (1 + s + s^2), 0 above the floor
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
  constexpr auto by_floor = real<Pack>(1 / volume_floor);
  const Pack J = 1.0 + j, s = 1.0 - J * by_floor;
  const auto is_below = s > 0.0;
  Pack a = J, a_less_1 = j, below = zero_of(J);
  if (is_any(is_below)) {
    below = real<Pack>(volume_floor) / (1.0 + s * (1.0 + s));  // 1/y
    a = is_below ? below : J;
    a_less_1 = is_below ? below - 1.0 : j;
  }
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
  Isochoric<Pack> result{rho * (2.0 + rho), r * r * r, zero_of(J)};
  if (is_any(is_below)) {
    const Pack share = below * by_floor, slope = (1.0 + 2.0 * s) * share * by_floor;
    result.inverse = is_below ? slope : result.inverse;
    result.extended = is_below ? Pack(3.0 * s * s * share) : result.extended;
  }
  return result;
}

}  // namespace trocar
