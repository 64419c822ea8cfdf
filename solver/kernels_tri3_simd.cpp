// Kernels of element_tri3.h for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_tri3(Kernels& kernels);

void fill_tri3(Kernels& kernels) {
  fill_formulation<OnePoint<ElementTri3>, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
