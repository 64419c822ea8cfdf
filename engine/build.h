// From a scene to a simulation at time zero.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/scene.h"
#include "engine/simulation.h"

namespace trocar {

// Reads the body, partitions it, builds the parts that the scene uses and no others. Collective.
// Throws InputError on every rank.
std::unique_ptr<Simulation> build(const LoadedScene& loaded, Communicator& communicator);

// What looks at the whole mesh and where all would have to move, so that the first frame with a
// blade in the tissue need not: of a body that is built, or that a checkpoint has given.
void prepare_for_cuts(Simulation& s);

// (n_regions) [kg/m^3]
std::vector<double> region_densities(std::span<const Material> materials);
// What follows from surface, view, and the least step and altitude: the last part of
// rebuild_topology. Collective.
void follow_model(Simulation& s);

}  // namespace trocar
