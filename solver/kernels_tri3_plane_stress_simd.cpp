// Kernels of element_tri3_plane_stress.h for one instruction set (cmake/SimdKernels.cmake).
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_tri3_plane_stress(Kernels& kernels);

void fill_tri3_plane_stress(Kernels& kernels) {
  fill_formulation<ElementTri3PlaneStress, doubles, singles>(kernels);
}

}  // namespace trocar::TROCAR_ISA
