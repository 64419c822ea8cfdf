// Hourglass forces that relax with the isochoric stress, of viscoelastic one-point hexahedra: how
// much history they have. Their kernels (kernels.h) take one block at a time.
#pragma once

#include "solver/hourglass.h"
#include "solver/kernels.h"

namespace trocar {

[[gnu::always_inline]] constexpr bool has_hourglass_forces(Formulation formulation) {
  return formulation == HourglassStiffness::formulation ||
         formulation == HourglassEnhanced::formulation;
}

inline constexpr int n_hourglass_components = 3 * n_hourglass_modes;

// Numbers of history of an element's hourglass displacements, behind those of its point: where the
// history stands, then h of each branch. [m]
[[gnu::always_inline]] constexpr int history_of_hourglass(int n_branches) {
  return n_hourglass_components * (1 + n_branches);
}

}  // namespace trocar
