// What of a scene is wrong or without effect only its body can tell.
#pragma once

#include "engine/scene.h"
#include "engine/simulation.h"

namespace trocar {

// Supports, loads, markers, materials and those of what a cut makes, unused keys. An error where
// the scene can't be run as it is; warns where a part of it does nothing.
void check_body(const Simulation& s, OptionErrors& errors);

}  // namespace trocar
