// The state's fingerprint: equal for any number of ranks and threads.
#pragma once

#include <cstdint>

#include "engine/simulation.h"

namespace trocar {

// 64-bit digest of nodes, velocities, connectivity, histories of viscoelastic elements, what is
// held, closed jaws, time and step. What follows from these, or is found anew in each frame, such
// as contacts, is not in it. Collective.
std::uint64_t state_digest(const Simulation& s);

}  // namespace trocar
