// What a scene would cost, without running it: `trocar check`.
#pragma once

#include <string>

#include "engine/simulation.h"

namespace trocar {

// Measures a few steps and says stable step, steps per second, memory and real-time factor, as
// lines of text. Collective.
std::string predict(Simulation& s);

}  // namespace trocar
