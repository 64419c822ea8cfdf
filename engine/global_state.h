// Displacements, velocities and positions of nodes on this rank, as far as it asked for them:
// what cuts look at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/communicator.h"
#include "base/vec.h"

namespace trocar {

struct Simulation;

// NaN where nobody has asked.
struct GlobalState {
  std::vector<double> u, v;  // (n_nodes * 3) [m], [m/s]
  std::vector<Vec3> x;       // (n_nodes) [m]
  std::vector<std::uint8_t> is_known;
  std::vector<std::int32_t> known;  // in the order they were asked for, and copies of edits
};
// Of all nodes. Collective.
GlobalState gather_state(Simulation& s);
// Of no node, in the memory that it has.
void forget_state(std::size_t n_nodes, GlobalState& global);
// From here on it has these nodes; those that it has stay as they are. Nodes and what it has are
// the same on all of these ranks, which own all that are new. Collective among them.
void find_nodes(const Simulation& s, std::span<const std::int32_t> nodes, const Communicator& ranks,
                GlobalState& global);
void find_all_nodes(Simulation& s, GlobalState& global);
// This rank's part of it, of all nodes; time, step and last dt stay.
void scatter_state(Simulation& s, const GlobalState& global);
// The same after an edit: the first n_kept owned nodes keep their numbers, and all but `nodes` of
// them what they have. Collective among neighbours.
void scatter_edited(Simulation& s, std::size_t n_kept, std::span<const std::int32_t> nodes,
                    const GlobalState& global);

// (nodes * 6) displacements and velocities, on these ranks, which own all the nodes. Collective
// among them.
std::vector<double> motion_at(const Simulation& s, std::span<const std::int32_t> nodes,
                              const Communicator& ranks);

}  // namespace trocar
