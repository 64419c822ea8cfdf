// The table of all kernels of one instruction set; compiled once for each
// (cmake/SimdKernels.cmake).
#include <initializer_list>

#include "solver/kernels.h"
#include "solver/simd_width.h"

namespace trocar::TROCAR_ISA {

void fill_nodes(Kernels& kernels);
void fill_elements(Kernels& kernels);
void fill_hourglass(Kernels& kernels);
void fill_laws_local(Kernels& kernels);
void fill_laws_plane_stress(Kernels& kernels);
void fill_laws_averaged_pressure(Kernels& kernels);
Kernels make_kernels();

template <class... Materials>
static void fill_counts(Kernels& kernels, TypeList<Materials...>) {
  ((kernels.n_material_values[static_cast<int>(Materials::model)] = Materials::n_values), ...);
}

Kernels make_kernels() {
  Kernels kernels{};
  fill_counts(kernels, MaterialList{});
  for (auto* const fill : {fill_nodes, fill_elements, fill_hourglass, fill_laws_local,
                           fill_laws_plane_stress, fill_laws_averaged_pressure})
    fill(kernels);
  return kernels;
}

}  // namespace trocar::TROCAR_ISA
