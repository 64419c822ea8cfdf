// The body in equilibrium under gravity and supports before the first frame, so that no scene
// begins with a body that drops and swings.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene.h"
#include "engine/simulation.h"

namespace trocar {

// (n_nodes) Components that supports and holds keep anywhere in a piece, at its lowest node. piece:
// of each node (connected_nodes).
std::vector<FixedMask> held_components(const Simulation& s, std::span<const std::int32_t> piece);

// An error if gravity or loads move a piece of the body along an axis in which nothing holds it.
void check_is_held(const Simulation& s, OptionErrors& errors);

// Relaxes the state that build made, with moving supports where they are at time zero; time and
// step stay 0, viscous overstress too, and the energy ledger begins anew. Instruments take no part:
// throws InputError if one reaches into the body that was found, and SimulationError, with the body
// as it was, if there is none. False, with the body as it was, if `stop` was set on a rank.
// Collective.
bool start_in_equilibrium(const LoadedScene& loaded, Simulation& s,
                          const std::atomic<bool>* stop = nullptr);

}  // namespace trocar
