// How much the bound of an element's highest frequency grows with its tangent stiffness.
#pragma once

#include "solver/pack.h"

namespace trocar {

// Undeformed: omega^2 <= (n/rho) (lambda+ tr G + 2 mu lambda_max(G)); deformed: the same with alpha
// and beta. Their ratio is monotone in tr G / lambda_max(G), which lies in [1, 3], so the larger of
// the two ends holds for any element. At least 1: a step never grows beyond the undeformed one,
// and rounding makes no difference at rest.
template <class Pack>
[[gnu::always_inline]] inline Pack stiffening_of(const Pack& alpha, const Pack& beta,
                                                 const Pack& lambda, const Pack& mu) {
  const Pack zero = mu - mu, lambda_plus = larger(zero, lambda);
  const Pack low = (alpha + beta) / (lambda_plus + 2.0 * mu);
  const Pack high = (3.0 * alpha + beta) / (3.0 * lambda_plus + 2.0 * mu);
  // The order of the operands keeps a NaN of low or high.
  const Pack most = low < high ? high : low;
  return most < real<Pack>(1 + 1e-6) ? zero + 1.0 : most;
}

}  // namespace trocar
