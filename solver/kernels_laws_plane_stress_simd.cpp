// Kernels of all materials, with a free thickness, for one instruction set.
#include "solver/kernel_laws.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_laws_plane_stress(Kernels& kernels);

void fill_laws_plane_stress(Kernels& kernels) {
  fill_laws<PackOf<double, doubles>, LawKind::plane_stress>(kernels.of[0], MaterialList{});
  fill_laws<PackOf<float, singles>, LawKind::plane_stress>(kernels.of[1], MaterialList{});
}

}  // namespace trocar::TROCAR_ISA
