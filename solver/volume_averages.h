// Volume changes averaged over the elements around a node (element_tet4_nodal_pressure.h).
#pragma once

#include "mesh/mesh.h"
#include "solver/model.h"

namespace trocar {

// Fills model.averages and the fields of model.blocks, which hold their constants.
void link_volume_averages(const Mesh& mesh, std::span<const Material> materials, Model& model);

}  // namespace trocar
