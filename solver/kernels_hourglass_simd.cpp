// Kernels of relaxing hourglass forces for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_hourglass.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

HourglassKernels make_hourglass_kernels(Precision precision);

HourglassKernels make_hourglass_kernels(Precision precision) {
  using Elements = TypeList<ElementHex8, ElementHex8Enhanced>;
  return precision == Precision::in_single ? hourglass_kernels<PackOf<float, singles>>(Elements{})
                                           : hourglass_kernels<PackOf<double, doubles>>(Elements{});
}

}  // namespace trocar::TROCAR_ISA
