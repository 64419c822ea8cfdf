// The kernels for one instruction set; compiled once for each (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"

namespace trocar::TROCAR_ISA {

namespace width_of {
inline constexpr int sse2 = 2, avx2 = 4, avx512 = 8;
}  // namespace width_of

const Kernels& kernels();

const Kernels& kernels() {
  static constexpr Kernels table = make_kernels<PackOf<width_of::TROCAR_ISA>::Real>(ElementList{});
  return table;
}

}  // namespace trocar::TROCAR_ISA
