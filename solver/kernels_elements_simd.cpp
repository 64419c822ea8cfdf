// Kernels of all elements for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_elements.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_elements(Kernels& kernels);

void fill_elements(Kernels& kernels) {
  trocar::fill_elements<PackOf<double, doubles>>(kernels.of[0], ElementList{});
  trocar::fill_elements<PackOf<float, singles>>(kernels.of[1], ElementList{});
}

}  // namespace trocar::TROCAR_ISA
