// The state's fingerprint: equal for any number of ranks and threads.
#pragma once

#include <cstdint>

#include "engine/simulation.h"

namespace trocar {

// 64-bit digest of nodes, velocities, connectivity, what is held, closed jaws, time and step. What
// follows from these or is found anew in each frame, such as contacts, is not in it, nor are
// histories of viscoelastic elements: they have come as far as forces were last asked for, which
// depends on what a run tells. Collective.
std::uint64_t state_digest(const Simulation& s);

}  // namespace trocar
