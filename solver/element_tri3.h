// Three-node triangle in plane strain: F33 = 1, no force along z. Constant gradient
// H = sum_a u_a (x) B_a, B_0 = -(B_1 + B_2); V is area times thickness.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/stash.h"
#include "solver/tensor.h"

namespace trocar {

struct ElementTri3 {
  static constexpr Formulation formulation = Formulation::tri3_plane_strain;
  static constexpr int n_corners = 3;
  static constexpr int value_B = 0;  // B_1, B_2: x and y each
  static constexpr int n_values = value_B + 4;

  static constexpr int n_kept = 0;

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[3][3],
                                                    const Stash<Pack>& = {}) {
    Tensor<Pack> H;
    const Pack zero = zero_of(u[0][0]);
    for (int i = 0; i < 3; ++i) H(i, 2) = H(2, i) = zero;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        H(i, j) =
            (u[1][i] - u[0][i]) * value(value_B + j) + (u[2][i] - u[0][i]) * value(value_B + 2 + j);
    return H;
  }

  template <class Pack>
  [[gnu::always_inline]] static void forces(const BlockValues<Pack>& value, const Stash<Pack>&,
                                            const Tensor<Pack>& VP, Pack (&f)[3][3]) {
    for (int i = 0; i < 2; ++i) {
      for (int a = 1; a < 3; ++a)
        f[a][i] = VP(i, 0) * value(value_B + 2 * a - 2) + VP(i, 1) * value(value_B + 2 * a - 1);
      f[0][i] = -(f[1][i] + f[2][i]);
    }
    for (int a = 0; a < 3; ++a) f[a][2] = zero_of(VP(0, 0));
  }
};

}  // namespace trocar
