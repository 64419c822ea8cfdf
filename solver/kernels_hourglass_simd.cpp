// Kernels of relaxing hourglass forces for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_hourglass.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_hourglass(Kernels& kernels);

void fill_hourglass(Kernels& kernels) {
  using Elements = TypeList<ElementHex8, ElementHex8Enhanced>;
  kernels.of[0].hourglass = hourglass_kernels<PackOf<double, doubles>>(Elements{});
  kernels.of[1].hourglass = hourglass_kernels<PackOf<float, singles>>(Elements{});
}

}  // namespace trocar::TROCAR_ISA
