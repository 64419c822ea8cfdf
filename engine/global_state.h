// Displacements, velocities and positions of all nodes on every rank: what cuts look at.
#pragma once

#include <vector>

#include "base/vec.h"

namespace trocar {

struct Simulation;

struct GlobalState {
  std::vector<double> u, v;  // (n_nodes * 3)
  std::vector<Vec3> x;       // (n_nodes)
  bool has_velocities = false;
};
// Collective.
GlobalState gather_state(Simulation& s);
// Into vectors that are large enough from the second time on; without velocities. Collective.
void gather_positions(Simulation& s, GlobalState& global);
void gather_velocities(Simulation& s, GlobalState& global);
// This rank's part of it; time, step and last dt stay.
void scatter_state(Simulation& s, const GlobalState& global);

}  // namespace trocar
