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

// Whether a search of the body has shown that the plan's local steps save work; none before one
// ends.
enum class LocalStepVerdict : std::uint8_t { none, kept, given_up };
// given_up also without a plan that is worth it.
LocalStepVerdict local_step_verdict(const Simulation& s);
// Of the same plan before.
void take_verdict(LocalStepVerdict verdict, Simulation& s);

// Plans on the whole mesh, if the scene asks for it, and makes the body. Collective.
void plan_local_steps(Simulation& s);
// The same after an edit: elements after it, and all their corners before and after it, ascending.
// Returns whether others than these nodes are as fine as they were; what was found of local steps
// holds on then. Collective.
bool follow_local_steps(std::span<const std::int32_t> elements, std::span<const std::int32_t> nodes,
                        Simulation& s);
// The same after all was planned anew, with plan and verdict from before.
bool keep_local_steps(const MultiRatePlan& before, LocalStepVerdict verdict,
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
