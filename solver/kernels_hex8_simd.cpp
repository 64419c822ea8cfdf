// Kernels of element_hex8.h for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_hex8(Kernels& kernels);

void fill_hex8(Kernels& kernels) {
  fill_formulation<OnePoint<ElementHex8>, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
