// Total hourglass control of one-point hexahedra: W_hg = 1/2 sum_pr A_pr q_p . q_r of the hourglass
// displacements q_p, which rotate with the body, so that W_hg is objective and makes no moment.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/tensor.h"

namespace trocar {

inline constexpr int n_hourglass_modes = 4;

// A = k I with k = c_mu mu V (sum_a |B_a|^2) / 8 (Flanagan and Belytschko 1981 with mu in place of
// lambda + 2 mu, which locks when nu tends to 1/2).
struct HourglassStiffness {
  static constexpr Formulation formulation = Formulation::hex8_one_point;
  static constexpr int n_values = 1;

  // g_p = dW_hg/dq_p
  template <class Pack>
  [[gnu::always_inline]] static void forces(const BlockValues<Pack>& value,
                                            const Pack (&q)[n_hourglass_modes][3],
                                            Pack (&g)[n_hourglass_modes][3]) {
    const Pack k = value(0);
    for (int p = 0; p < n_hourglass_modes; ++p)
      for (int i = 0; i < 3; ++i) g[p][i] = k * q[p][i];
  }
};

// The hourglass part of the hyperelastic energy itself, without a free constant: over a
// parallelepiped F = <F> + sum_p q_p (x) grad h_p / 8 with the monomials h_p, and the term
// mu/2 |F|^2 of a neo-Hookean material has the mean mu/2 |<F>|^2 + mu/2 sum_pr (grad h_p . grad
// h_r) q_p . q_r / 64. With grad xi_k / 8 = b_k, <xi_k^2> = 1/3 and all mixed means zero:
//   A_pp = mu V/3 (|b_k|^2 + |b_l|^2), A_pr = mu V/3 b_p . b_r   (h_p = xi_k xi_l; p, k, l differ)
//   A_33 = mu V/9 sum_k |b_k|^2                                 (h_3 = xi eta zeta, alone)
// The same as mu |dev sym|^2 of the gradients but for at most a quarter, and unlike it constant in
// any rotation. The volumetric energy is left out: it locks.
struct HourglassEnhanced {
  static constexpr Formulation formulation = Formulation::hex8_enhanced;
  static constexpr int value_A = 0;   // as SymmetricTensor
  static constexpr int value_A3 = 6;  // of xi eta zeta
  static constexpr int n_values = 7;

  template <class Pack>
  [[gnu::always_inline]] static void forces(const BlockValues<Pack>& value,
                                            const Pack (&q)[n_hourglass_modes][3],
                                            Pack (&g)[n_hourglass_modes][3]) {
    for (int i = 0; i < 3; ++i) {
      for (int p = 0; p < 3; ++p)
        g[p][i] = value(symmetric_index[p][0]) * q[0][i] + value(symmetric_index[p][1]) * q[1][i] +
                  value(symmetric_index[p][2]) * q[2][i];
      g[3][i] = value(value_A3) * q[3][i];
    }
  }
};

}  // namespace trocar
