// Where the body's energy comes from and goes to: the energies that it holds, and the work that
// contact, loads, grasped or moved nodes, blades and damping have done on it since the start; and
// what the supports bear. Only for scenes with a metrics output.
//
// Central differences obey m (v+ - v-) / dt + alpha m v = f exactly at every node, v = (v+ + v-)/2,
// so that F·v dt summed over the steps is the work of a force F to rounding. Kinetic energy and
// works then belong to the middle of the last step; sum dt/2 v-·f carries the kinetic energy to its
// end, where strain and gravity are evaluated. The same carries the work of viscous
// forces there; strain energy is that of the laws without relaxation. The first step takes v0 to
// v+ = v0 + dv; with v- = v0 - dv the sum would be 1/2 m v-·v+, that is, 1/2 m dv·dv less than
// 1/2 m v0·v0: so much less was there at the start.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/exact_sum.h"
#include "base/vec.h"
#include "engine/frame_log.h"
#include "engine/support_forces.h"
#include "solver/rank_body.h"

namespace trocar {

struct Simulation;

// What a ledger keeps from frame to frame.
struct EnergyMemory {
  std::int64_t first_frame = 0;        // how many had gone by when it was started
  EnergyWorks works;                   // since the start
  double initial = 0;                  // mechanical energy at the start, as above [J]
  double largest_stored = 0;           // strain and hourglass energy of any frame [J]
  double largest_hourglass_share = 0;  // of frames that store 1 % of that or more
};

// Of forces at nodes of this rank in this frame.
struct ForceWorks {
  std::vector<Vec3> before;  // velocity before the step [m/s]
  std::vector<double> work;  // [J]
};

struct EnergyLedger {
  EnergyMemory memory;
  // In the order of the contact set's nodes, of the holds, of the nodes that blades drag along and
  // of the loads' nodes.
  ForceWorks contact, holds, blade, loads;
  std::vector<double> earlier_contact_work;  // with the frame's earlier contact sets [J]
  double dt_mid = 0;                         // between the two velocities of the step [s]
  // (n_owned * 3) Of the step that starts it all.
  std::optional<std::vector<double>> start_velocity;
  double start_kinetic = 0;  // of what that step adds to it, until the frame's end [J]
  SupportForces support_forces;
};

// Starts the ledger with what the body holds now. Collective.
void open_energy_ledger(Simulation& s);

// Kinetic, strain and hourglass energy and that in the field of gravity. Collective.
EnergyState mechanical_energy(Simulation& s);
// Appends 1/2 m v- · v- + dt/2 v- · f and -m g · u of each owned node; forces are those of the
// present displacement.
void add_nodal_energies(const RankBody& body, std::vector<double>& kinetic,
                        std::vector<double>& gravity);

// Empties the sums of the frame; call when its contacts are known.
void begin_frame_work(Simulation& s);
// Where the contact set is another from here on in the frame.
void begin_contact_work(Simulation& s);
// Before and after integration and exchange: both velocities of the step. Collective in the first
// step.
void note_velocities(Simulation& s, double dt);
void add_work(Simulation& s);
// Adds the frame's work of all ranks to the ledger. Collective.
void close_frame_work(Simulation& s);
// What the balance of energies leaves, and where it jumps most from one frame to the next. What
// rounding alone leaves has no share.
struct BalanceError {
  double largest = 0, share = 0;  // [J]; of the largest energy turned over
  double time = 0;                // [s]
};
BalanceError balance_error(const Simulation& s);
// Tells at the end of a run if that is more than 5 %.
void note_balance(Simulation& s);

// The ledger of the frame into its row; notes an event, once, when hourglass energy is above 5 % of
// what is stored. Collective.
void report_energies(Simulation& s, FrameRow& row);

}  // namespace trocar
