// Three-node triangle in plane stress: the in-plane strain is that of plane strain, the law finds
// the thickness (law_plane_stress.h).
#pragma once

#include "solver/element_one_point.h"
#include "solver/element_tri3.h"

namespace trocar {

struct ElementTri3PlaneStress : OnePoint<ElementTri3> {
  static constexpr Formulation formulation = Formulation::tri3_plane_stress;
  static constexpr LawKind law = LawKind::plane_stress;
  static constexpr int value_ratio = ElementTri3::n_values;  // c = lambda / (lambda + 2 mu)
  static constexpr int value_compliance = value_ratio + 1;   // 1 / ((lambda + 2 mu) V) [1/J]
  static constexpr int n_values = value_compliance + 1;
};

}  // namespace trocar
