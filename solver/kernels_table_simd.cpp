// The table of all kernels of one instruction set; compiled once for each
// (cmake/SimdKernels.cmake). A new element is a file kernels_<element>_simd.cpp and two lines here.
#include "solver/kernel_loops.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_tri3(Kernels& kernels);
void fill_tri3_plane_stress(Kernels& kernels);
void fill_tet4(Kernels& kernels);
void fill_tet4_nodal_pressure(Kernels& kernels);
void fill_hex8(Kernels& kernels);
void fill_hex8_enhanced(Kernels& kernels);
void fill_hex8_full(Kernels& kernels);
Kernels make_kernels();

Kernels make_kernels() {
  Kernels kernels{};
  kernels.of[0].sum = sum_corner_forces<PackOf<double, doubles>, double>;
  kernels.of[1].sum = sum_corner_forces<PackOf<double, doubles>, float>;
  for (auto* const fill : {fill_tri3, fill_tri3_plane_stress, fill_tet4, fill_tet4_nodal_pressure,
                           fill_hex8, fill_hex8_enhanced, fill_hex8_full})
    fill(kernels);
  return kernels;
}

}  // namespace trocar::TROCAR_ISA
