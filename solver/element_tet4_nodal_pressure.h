// Four-node tetrahedron with averaged nodal pressure, variational form (after Bonet and Burton
// 1998, per region as Joldes, Wittek and Miller 2009): the volumetric energy counts at nodes,
//   W = sum_e V_e W_iso(F_e) + (1 - s) sum_a (V_a/4) K/2 theta_a^2 + s sum_e V_e K/2 j_e^2,
//   theta_a = sum_e V_e j_e / V_a,  V_a = sum_e V_e,  j = J - 1,
// over the elements of one region at node a. Its exact derivative is the force of a tetrahedron
// with
//   P_e = dW_iso/dF + K ((1 - s) theta_e + s j_e) cof F_e,  theta_e the mean of its corners,
// so that energy is conserved. The small share s binds modes that the averages alone don't see.
#pragma once

#include "solver/element_one_point.h"
#include "solver/element_tet4.h"

namespace trocar {

// Keeps theta_e behind its strain.
struct Tet4NodalPressure : OnePoint<ElementTet4> {
  static constexpr Formulation formulation = Formulation::tet4_nodal_pressure;
  static constexpr LawKind law = LawKind::averaged_pressure;
  static constexpr int n_kept = 1;
  static constexpr bool averages_volume = true;
};

template <class Element>
inline constexpr bool averages_volume_v = requires {
  Element::averages_volume;
};

}  // namespace trocar
