// Kernels of nodes for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_nodes.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_nodes(Kernels& kernels);

void fill_nodes(Kernels& kernels) {
  kernels.nodes = node_kernels<PackOf<double, doubles>>();
}

}  // namespace trocar::TROCAR_ISA
