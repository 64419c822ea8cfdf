// How a step talks to the ranks around it: one message a neighbour and step (two with averaged
// volume changes), no collective, no allocation. What border nodes do travels while the elements
// before the first one that reads halo nodes are computed. So of parts in the order of their
// numbers each follows the one before by the time of a message, and none waits.
#pragma once

#include <optional>

#include "base/communicator.h"
#include "mesh/partition.h"
#include "solver/model.h"

namespace trocar {

class ElementWatch;

// The default one is alone.
struct Neighbours {
  Communicator* communicator = nullptr;  // null: alone
  std::optional<HaloExchange> motion, theta;
  enum class UnderWay { none, motion, theta } under_way = UnderWay::none;
  double waited = 0;  // for messages, since it was made [s]
};
// Keeps pointers to both.
Neighbours make_neighbours(const Halo& halo, const Model& model, Communicator& communicator);

// Sends displacements; until finish_exchange halo nodes hold old ones. Nobody reads their
// velocities. Collective among neighbours, as are all of these.
void start_exchange(Neighbours& neighbours, State& state);
// Waits for what is under way, if anything.
void finish_exchange(Neighbours& neighbours, State& state);
// state.theta of all local nodes, after an exchange that may be under way: before watch and
// energy_terms.
void update_volume_change(const Model& model, Neighbours& neighbours, State& state,
                          Scratch& scratch);
// The one way to scratch.force = mass * gravity - internal force(u): ends an exchange that is under
// way, averages volume changes and exchanges these, inside first. See compute_force.
void find_force(const Model& model, Neighbours& neighbours, State& state, Scratch& scratch,
                ElementWatch* watch = nullptr);
// find_force and integrate in one pass over all nodes but the waiting ones, with the same bits: of
// a step in which nobody adds to the others' forces or asks for them, no works are kept and no mass
// is scaled. The step ends with step_waiting; until then the others are ahead.
void step_others(const Model& model, Neighbours& neighbours, const WaitingNodes& waiting, double dt,
                 State& state, Scratch& scratch);

}  // namespace trocar
