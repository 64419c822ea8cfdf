#include "solver/material_check.h"

#include <string>
#include <vector>

#include "base/error.h"
#include "solver/element_setup.h"
#include "solver/kernels.h"
#include "solver/material_setup.h"
#include "solver/simd.h"

namespace trocar {

namespace {

// Whether any element of the region is of the type, at [region * n_element_types + type].
std::vector<bool> types_of_regions(const Mesh& mesh, std::size_t n_regions) {
  std::vector<bool> has(n_regions * n_element_types);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    has[static_cast<std::size_t>(mesh.element_region[e]) * n_element_types +
        static_cast<std::size_t>(mesh.element_type[e])] = true;
  return has;
}

void check(const Mesh& mesh, std::size_t region, const std::string& fault) {
  if (fault.empty()) return;
  const std::string name = region < mesh.region_name.size() ? mesh.region_name[region] : "";
  throw InputError((name.empty() ? "" : "region \"" + name + "\": ") + fault);
}

}  // namespace

std::string misfit_of(const Material& material, Formulation formulation, Precision precision) {
  const KernelsOfPrecision& kernels = kernels_of(Simd::scalar).of[static_cast<int>(precision)];
  const LawKind kind = kernels.element[static_cast<int>(formulation)].law;
  const LawKernels& law = kernels.law[static_cast<int>(kind)][static_cast<int>(material.model)];
  if (law.stress != nullptr) return {};
  return std::string(name_of(formulation)) +
         " elements need a material with a volumetric energy of its own, such as neo-hookean";
}

void check_materials(const Mesh& mesh, std::span<const Material> materials,
                     const SolverOptions& options) {
  const std::vector<bool> has = types_of_regions(mesh, materials.size());
  for (std::size_t r = 0; r < materials.size(); ++r) {
    check(mesh, r, fault_of(materials[r]).sentence);
    for (std::size_t k = 0; k < n_element_types; ++k)
      if (has[r * n_element_types + k])
        check(mesh, r,
              misfit_of(
                  materials[r],
                  of_shape(static_cast<ElementType>(k), options.tri3, options.tet4, options.hex8),
                  options.precision));
  }
}

}  // namespace trocar
