#pragma once

#include <span>
#include <string>

#include "mesh/mesh.h"
#include "solver/material.h"
#include "solver/model.h"

namespace trocar {

// Why elements of this kind can't be of the material, "" if they can.
std::string misfit_of(const Material& material, Formulation formulation, Precision precision);

// Throws InputError with the region's name if its material is impossible or none that the region's
// elements can have. The same on every rank: looks at the whole mesh. O(n_elements).
void check_materials(const Mesh& mesh, std::span<const Material> materials,
                     const SolverOptions& options);

}  // namespace trocar
