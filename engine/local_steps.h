// Small elements with steps of their own ([solver] multirate): which, and their body.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/multirate.h"

namespace trocar {

struct Simulation;

struct LocalStepPlan {
  std::vector<RestingElement> resting;  // of the whole mesh
  MultiRatePlan plan;
};

// Plans on the whole mesh, if the scene asks for it, and makes the body. Collective.
void plan_local_steps(Simulation& s);
// The same after an edit: elements after it, and all their corners before and after it, ascending.
// Returns whether others than these nodes are as fine as they were; local steps that were given up
// stay so then. Collective.
bool follow_local_steps(std::span<const std::int32_t> elements, std::span<const std::int32_t> nodes,
                        Simulation& s);
// The same answer after all was planned anew: `before` and whether local steps had been given up.
bool keep_local_steps(const MultiRatePlan& before, bool is_given_up,
                      std::span<const std::int32_t> nodes, Simulation& s);

// Sets s.has_local_steps of a frame whose contacts and drag are known. Contact and drag know of no
// substeps: small elements would spring free of an instrument in each of them, and a plate pressed
// 0.57 of its force. While one may touch them, or tissue tissue at them, and while a blade is in
// the tissue, or comes into it in the frame, all elements take their step. t: for the event that
// says so.
void choose_local_steps(Simulation& s, double t);
// Of the stable step with local steps: what the frame may take.
double step_share(const Simulation& s);

}  // namespace trocar
