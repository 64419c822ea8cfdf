// Kernels of the enhanced one-point hexahedron for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_hex8_enhanced(Kernels& kernels);

void fill_hex8_enhanced(Kernels& kernels) {
  fill_formulation<OnePoint<ElementHex8Enhanced>, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
