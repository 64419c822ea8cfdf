// Kernels of element_hex8_full.h for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_hex8_full(Kernels& kernels);

void fill_hex8_full(Kernels& kernels) {
  fill_formulation<ElementHex8Full, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
