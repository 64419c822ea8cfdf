// From an output folder to the checkpoint that a run goes on from.
#pragma once

#include <string>

#include "engine/checkpoint.h"
#include "engine/scene.h"

namespace trocar {

// Rank 0 reads and checks the folder's checkpoint; every rank gets it. Collective; throws
// InputError on every rank if there is none, if it is damaged, or if it is of another scene.
Checkpoint load_checkpoint(const std::string& folder, const LoadedScene& loaded,
                           Communicator& communicator);

// Throws InputError with place and name of the first key whose value differs from that in `before`,
// the effective scene of the stopped run. Duration, pace, overrun, checkpoints, cameras and
// outputs may differ.
void require_same_scene(const std::string& before, const LoadedScene& now);

}  // namespace trocar
