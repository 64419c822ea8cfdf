// From a scene to a simulation at time zero.
#pragma once

#include <memory>

#include "engine/scene.h"
#include "engine/simulation.h"

namespace trocar {

// Reads the body, partitions it, builds the parts that the scene uses and no others. Collective.
// Throws InputError on every rank.
std::unique_ptr<Simulation> build(const LoadedScene& loaded, Communicator& communicator);

}  // namespace trocar
