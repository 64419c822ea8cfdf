// The state's fingerprint: equal for any number of ranks and threads.
#pragma once

#include <cstdint>

#include "engine/simulation.h"

namespace trocar {

// 64-bit digest of nodes, velocities, connectivity, time and step. Collective.
std::uint64_t state_digest(const Simulation& s);

}  // namespace trocar
