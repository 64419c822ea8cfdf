// Steady states by dynamic relaxation (Underwood 1983): damped motion with masses and a step of its
// own choice, because the way to equilibrium does not matter. Masses let every element have the
// same highest frequency; damping follows the lowest one that is still moving, estimated as it
// goes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "solver/model.h"
#include "solver/neighbours.h"
#include "solver/step.h"

namespace trocar {

struct RelaxTask {
  // Adds a share of the loads on the present u to a force (n_owned * 3) [N]; or empty.
  std::function<void(double share, std::span<double> force)> add_load;
  std::span<const PrescribedNode> prescribed;  // where held nodes go; other members unused
  // Loads, gravity and held nodes come on smoothly over the first ones; 0: at once.
  std::int64_t ramp_iterations = 500;
  std::int64_t max_iterations = 1000000;
  // Largest residual, relative to the forces of supports and holders (see Relaxation). Elements in
  // single precision leave some 1e-6 of it: ask for no less than 3e-5 there.
  double tolerance = 1e-6;
  Neighbours* neighbours = nullptr;  // null: alone
  // Set by a signal on any rank: the relaxation ends at its next look. Null: nobody stops it.
  const std::atomic<bool>* stop = nullptr;
};

struct Relaxation {
  std::int64_t iterations = 0;
  // Root of the sum of squares of what is out of balance (force, or damping where it is larger),
  // over that of the forces of supports and holders (at least a thousandth of the greatest
  // imbalance met, so that bodies without any come to rest too).
  double residual = 0;
  bool is_converged = false;
  bool is_finite = true;  // otherwise it diverged
  bool is_stopped = false;
};

// Moves `state` into equilibrium: u changes, v and last_dt become 0, time and step stay.
// Viscoelastic elements answer with their long-term moduli and are left without overstress, as if
// they had always been there. Afterwards scratch.force is load + gravity - internal force: the
// residual at free nodes, the negative of the support's or holder's force at others. The same bits
// for any number of ranks and threads. Collective.
Relaxation relax(const Model& model, const RelaxTask& task, State& state, Scratch& scratch);

// (n_owned) masses for which a step of 1 is the limit at rest, of an iteration without time.
std::vector<double> relaxation_mass(const Model& model);

// The same iteration by iteration, for a caller that adds forces of its own (contact).
struct Relaxer {
  std::vector<double> mass;          // relaxation_mass
  std::vector<double> by_mass;       // (n_owned * 3) one over it; 0 where the component is held
  std::vector<double> force_before;  // (n_owned * 3) of the iteration before, kept for a look
  double damping = 0, step = 0;      // c, dt
  double greatest_imbalance = 0;
  Relaxation result;
  std::vector<double> room[4];  // of a look
};
Relaxer make_relaxer(const Model& model, std::span<const PrescribedNode> prescribed);
// In place of `integrate`, after scratch.force is complete: moves free components of owned nodes.
// Every 20th call looks at all ranks, the others at none; result.residual is then up to date.
void relax_step(const Model& model, const Scratch& scratch, Communicator& communicator,
                Relaxer& relaxer, State& state);

}  // namespace trocar
