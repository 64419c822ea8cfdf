// What the set-ups of all elements share.
#include "solver/element_setup.h"

#include <algorithm>

#include "solver/element_list.h"
#include "solver/symmetric_eigenvalues.h"

namespace trocar {

ElementConstants element_constants(Formulation formulation, const ElementInput& input) {
  constexpr std::array setup = {constants_tri3,     constants_tri3_plane_stress,
                                constants_tet4,     constants_tet4_nodal_pressure,
                                constants_hex8,     constants_hex8_enhanced,
                                constants_hex8_full};
  static_assert(setup.size() == n_formulations);
  return setup[static_cast<std::size_t>(formulation)](input);
}

void add_gradient(const Vec3& B, SymmetricTensor<double>& G) {
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) G.v[symmetric_index[i][j]] += B[i] * B[j];
}

double frequency_bound(const SymmetricTensor<double>& G, int n_corners, const ElementInput& input) {
  return n_corners / input.density *
         (std::max(input.lambda, 0.0) * trace(G) + 2 * input.mu * largest_eigenvalue(G));
}

}  // namespace trocar
