// Takes a mesh edit over into everything that depends on the mesh, in one order.
#pragma once

#include <span>
#include <vector>

#include "engine/global_state.h"
#include "engine/simulation.h"

namespace trocar {

// Mesh, mass, owners, part, model, state, surface, holds, contact; momenta, strain energy and
// kinetic energy around the edit are restored (apply_cut_momentum.h, apply_cut_energy.h). `global`
// is carried along and gets what is around the edit. Collective. Adds what it measured to `record`.
void apply_cut(Simulation& s, const MeshEdit& edit, GlobalState& global, CutRecord& record);

}  // namespace trocar
