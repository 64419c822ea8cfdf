// Kernels of element_tet4_nodal_pressure.h for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_tet4_nodal_pressure(Kernels& kernels);

void fill_tet4_nodal_pressure(Kernels& kernels) {
  fill_formulation<Tet4NodalPressure, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
