// Four-node tetrahedron: constant gradient H = sum_a u_a (x) B_a, f_a = V P B_a, where B_1, B_2,
// B_3 are the rows of the inverse of [X_1 - X_0, X_2 - X_0, X_3 - X_0] and B_0 = -sum.
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/stash.h"
#include "solver/tensor.h"

namespace trocar {

struct ElementTet4 {
  static constexpr Formulation formulation = Formulation::tet4;
  static constexpr int n_corners = 4;
  static constexpr int value_B = 0;  // B_1, B_2, B_3
  static constexpr int n_values = value_B + 9;

  static constexpr int n_kept = 0;

  template <class Pack>
  [[gnu::always_inline]] static Tensor<Pack> strain(const BlockValues<Pack>& value,
                                                    const Pack (&u)[4][3],
                                                    const Stash<Pack>& = {}) {
    Tensor<Pack> H;
    for (int i = 0; i < 3; ++i) {
      const Pack d1 = u[1][i] - u[0][i], d2 = u[2][i] - u[0][i], d3 = u[3][i] - u[0][i];
      for (int j = 0; j < 3; ++j)
        H(i, j) =
            d1 * value(value_B + j) + d2 * value(value_B + 3 + j) + d3 * value(value_B + 6 + j);
    }
    return H;
  }

  template <class Pack>
  [[gnu::always_inline]] static void forces(const BlockValues<Pack>& value, const Stash<Pack>&,
                                            const Tensor<Pack>& VP, Pack (&f)[4][3]) {
    for (int i = 0; i < 3; ++i) {
      for (int a = 1; a < 4; ++a) {
        const int B = value_B + 3 * (a - 1);
        f[a][i] = VP(i, 0) * value(B) + VP(i, 1) * value(B + 1) + VP(i, 2) * value(B + 2);
      }
      f[0][i] = -(f[1][i] + f[2][i] + f[3][i]);
    }
  }
};

}  // namespace trocar
