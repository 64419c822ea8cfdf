// Kernels of all materials, at an averaged pressure, for one instruction set.
#include "solver/kernel_laws.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_laws_averaged_pressure(Kernels& kernels);

void fill_laws_averaged_pressure(Kernels& kernels) {
  fill_laws<PackOf<double, doubles>, LawKind::averaged_pressure>(kernels.of[0], MaterialList{});
  fill_laws<PackOf<float, singles>, LawKind::averaged_pressure>(kernels.of[1], MaterialList{});
}

}  // namespace trocar::TROCAR_ISA
