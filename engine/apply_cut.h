// Takes a mesh edit over into everything that depends on the mesh, in one order.
#pragma once

#include <span>
#include <vector>

#include "engine/global_state.h"
#include "engine/simulation.h"

namespace trocar {

// Mesh, mass, owners, part, model, state, surface, holds, contact; linear and angular momentum of
// the patch are restored by a rigid velocity increment. `global` is carried along and gets what is
// around the edit. Collective. Adds what it measured to `record`.
void apply_cut(Simulation& s, const MeshEdit& edit, GlobalState& global, CutRecord& record);

}  // namespace trocar
