// Instruments begin outside of the tissue: one that is inside would have to be pushed out.
#pragma once

#include <string>

#include "engine/scene.h"
#include "engine/simulation.h"

namespace trocar {

// Throws InputError, naming the first key of its path, if an instrument reaches deeper than
// `allowed` [m] into the body as it lies at time zero. `what`: the body, in the sentence.
void check_instruments_outside(const LoadedScene& loaded, double allowed, const std::string& what,
                               Simulation& s);

}  // namespace trocar
