// Whether the bound of tangent_bound.h can exceed a limit, from above and without most of its roots
// and quotients, which take as long as a fifth of a step: most elements are not those that set it.
#pragma once

#include "solver/deformation.h"
#include "solver/symmetric_eigenvalues.h"
#include "solver/tensor.h"

namespace trocar {

// y(c) of symmetric_eigenvalues.h is concave: below its tangents at c = 1, 0 and -0.9.
template <class Pack>
[[gnu::always_inline]] inline Pack root_at_most(const Pack& c) {
  const Pack at_one = real<Pack>(8.0 / 9 + 1e-7) + real<Pack>(1.0 / 9) * c;
  const Pack at_zero = real<Pack>(0.8660255) + real<Pack>(1.0 / 6) * c;
  const Pack at_end = real<Pack>(1.162228) + real<Pack>(0.597762) * c;
  const Pack least = at_one < at_zero ? at_one : at_zero;
  return least < at_end ? least : at_end;
}

// Bounds of the squares of the stretches s_i.
template <class Pack>
struct StretchBounds {
  Pack mean;       // of s_i^2, exactly
  Pack above;      // max s_i^2 - mean is at most this
  Pack above_low;  // and at least this
  Pack below;      // mean - min s_i^2 is at most this
};

template <class Pack>
[[gnu::always_inline]] inline StretchBounds<Pack> stretch_bounds(
    const SymmetricTensor<Pack>& twice_E) {
  const auto [m, p, c] = deviator_invariants(twice_E);
  const Pack twice_p = p + p;
  // A concave function is above its chord, too.
  return {1.0 + m, twice_p * root_at_most(c), twice_p * (0.75 + 0.25 * c),
          twice_p * root_at_most(Pack(-c))};
}

// Of W = mu/2 (I1bar - 3) + K/2 (J - 1)^2, in the letters of tangent_bound.h: positive where the
// bound may exceed the limit. M = 2 mu max lbar^2, t_i = mu (lbar_i^2 - mean), and with s_i s_j =
// J / s_k, t_i + t_j = -t_k, r <= 1 + (max s^2 / min s^2 - 1)^2 / 32; beta is at most the largest
// of
//   (M - p - t_min) / min s^2,  (M r - p + t_max / 2) max s / J,  (t_max + p) max s / J.
// The cube root of J is concave and J^(-2/3) convex: 1 - 2 j/3 <= J^(-2/3) <= (1 + j/3) / J.
template <class Pack>
[[gnu::always_inline]] inline Pack excess_of_I1bar(const Tensor<Pack>& H, const Pack& K,
                                                   const Pack& mu, const Pack& limit) {
  constexpr bool is_single = sizeof(RealOf<Pack>) == sizeof(float);
  constexpr auto rounding = real<Pack>(1 + (is_single ? 1e-4 : 1e-9));
  const StretchBounds<Pack> s2 = stretch_bounds(twice_green_strain(H));
  const Pack zero = zero_of(mu), j = volume_change(H, cofactor(H)), J = 1.0 + j, p = K * J * j;
  const Pack inverse_J = 1.0 / J;
  const Pack most = s2.mean + s2.above, least = s2.mean - s2.below;
  const Pack inverse = 1.0 / least, ratio = (most - least) * inverse;
  const Pack lbar = mu * (1.0 + j * real<Pack>(1.0 / 3)) * inverse_J;
  const Pack M = 2.0 * lbar * most, t_max = lbar * s2.above;
  const Pack of_pair = 0.5 * (1.0 + most) * inverse_J;  // >= max s / J
  const Pack r = 1.0 + ratio * ratio * real<Pack>(1.0 / 32);
  Pack beta = larger(zero, Pack(M - p + lbar * s2.below)) * inverse;
  beta = larger(beta, Pack((M * r - p + 0.5 * t_max) * of_pair));
  beta = larger(beta, Pack((t_max + p) * of_pair));
  const Pack lbar_low = mu * (1.0 - j * real<Pack>(2.0 / 3));
  const Pack M_low = 2.0 * lbar_low * (s2.mean + s2.above_low);
  const Pack alpha =
      larger(zero, Pack(K * J * (2.0 * J - 1.0) - M_low * real<Pack>(1.0 / 3))) * inverse;
  const Pack lambda = larger(zero, Pack(K - real<Pack>(2.0 / 3) * mu));
  const auto is_within = (rounding * (alpha + beta) <= limit * (lambda + 2.0 * mu)) &
                         (rounding * (3.0 * alpha + beta) <= limit * (3.0 * lambda + 2.0 * mu)) &
                         (limit > rounding) & (least > real<Pack>(0.05)) &
                         (J > real<Pack>(1.01 * volume_floor));
  return is_within ? zero : zero + 1.0;  // what is not a number is not within
}

}  // namespace trocar
