// Hourglass forces that relax with the isochoric stress: what their kernels offer, one block at a
// time, apart from kernels.h because only lists of viscoelastic one-point hexahedra ask for them.
// Raw pointers only, as there.
#pragma once

#include "solver/hourglass.h"
#include "solver/kernels.h"
#include "solver/simd.h"
#include "solver/viscous_step.h"

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

// While the strain is in the stash: history ([number][lane]) to the present, in place of the
// hourglass displacements those that make the relaxed forces, and to `balance` ([9][lane], of the
// list's precision) the stress that is missing then.
using HourglassRelaxKernel = void (*)(const BlockTask& task, const ViscousStep& step,
                                      double* history, void* balance);
// V P += balance, as soon as the stress is in the stash.
using HourglassBalanceKernel = void (*)(const BlockTask& task, const void* balance);

struct HourglassKernels {
  // Of elements without hourglass forces null. By whether the law is that of small strain.
  HourglassRelaxKernel relax[2][n_formulations];
  HourglassBalanceKernel balance;
};

// As active_kernels.
const HourglassKernels& active_hourglass_kernels(Precision precision);

}  // namespace trocar
