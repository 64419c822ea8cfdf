// Kernels of all materials, at their own strain, for one instruction set.
#include "solver/kernel_laws.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_laws_local(Kernels& kernels);

void fill_laws_local(Kernels& kernels) {
  fill_laws<PackOf<double, doubles>, LawKind::local>(kernels.of[0], MaterialList{});
  fill_laws<PackOf<float, singles>, LawKind::local>(kernels.of[1], MaterialList{});
}

}  // namespace trocar::TROCAR_ISA
