// Kernels of element_tet4.h for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_tet4(Kernels& kernels);

void fill_tet4(Kernels& kernels) {
  fill_formulation<OnePoint<ElementTet4>, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
