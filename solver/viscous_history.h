// What relaxes is a number s in the undeformed body's axes, with its history: s where the history
// stands, then h of each branch,
//   s_relaxed = s + sum_b h_b - sum_b g_b s,
//   h_b+ = exp(-x) h_b + g_b (1 - exp(-x)) / x (s+ - s),  x = dt / tau_b,
// second order and stable for any dt. It is in double always: single would stop relaxing at
// tau / dt ~ 1e6.
#pragma once

#include "solver/in_double.h"
#include "solver/isochoric.h"
#include "solver/tensor.h"
#include "solver/viscous_step.h"

namespace trocar {

enum class HistoryCall { moves_history, trial };

// One of n components, [s, h_0, h_1 …][component][lane], to the present; what it is more than s. A
// trial leaves the history alone.
template <HistoryCall call, class Pack>
[[gnu::always_inline]] inline Pack advance_history(const ViscousStep& step, int n, int component,
                                                   const Pack& s, double* history) {
  constexpr int width = pack_width<Pack>, lanes = block_lanes<Pack>;
  double now[width], sum[width];
  double* const before = history + component * lanes;
  store_in_double(now, s);
  for (int l = 0; l < width; ++l) sum[l] = -step.share_sum * now[l];
  for (int b = 0; b < step.n_branches; ++b) {
    double* const h = history + (n * (1 + b) + component) * lanes;
    for (int l = 0; l < width; ++l) {
      const double present = step.decay[b] * h[l] + step.gain[b] * (now[l] - before[l]);
      if constexpr (call == HistoryCall::moves_history) h[l] = present;
      sum[l] += present;
    }
  }
  RealOf<Pack> result[width];
  for (int l = 0; l < width; ++l) {
    if constexpr (call == HistoryCall::moves_history) before[l] = now[l];
    result[l] = static_cast<RealOf<Pack>>(sum[l]);
  }
  return load<Pack>(result);
}

// 1/J; below the floor of isochoric.h its factor for it, which keeps histories finite through
// J = 0.
template <class Pack>
[[gnu::always_inline]] inline Pack finite_inverse_J(const Pack& j) {
  const Isochoric<Pack> iso = isochoric(j);
  return iso.extended > 0.0 ? iso.inverse : 1.0 / (1.0 + j);
}

}  // namespace trocar
