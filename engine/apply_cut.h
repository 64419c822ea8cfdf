// Takes a mesh edit over into everything that depends on the mesh, in one order.
#pragma once

#include <span>
#include <vector>

#include "engine/simulation.h"

namespace trocar {

// The state of all nodes on every rank. (n_nodes * 3)
struct GlobalState {
  std::vector<double> u, v;
  std::vector<Vec3> x;
};
// Collective.
GlobalState gather_state(Simulation& s);
// Without velocities. Collective.
GlobalState gather_positions(Simulation& s);
// This rank's part of it; time, step and last dt stay.
void scatter_state(Simulation& s, const GlobalState& global);

// Mesh, mass, owners, part, model, state, surface, holds, contact; linear and angular momentum of
// the patch are restored by a rigid velocity increment. `global` is carried along, with velocities
// then. Collective. Adds what it measured to `record`.
void apply_cut(Simulation& s, const MeshEdit& edit, GlobalState& global, CutRecord& record);

}  // namespace trocar
