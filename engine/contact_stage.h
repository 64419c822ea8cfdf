// Contact within a frame: detected once at its beginning, evaluated in every substep.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/exact_sum.h"
#include "collision/contact_force.h"
#include "collision/detector.h"
#include "engine/holds.h"
#include "engine/surface_view.h"
#include "engine/tool.h"

namespace trocar {

struct ContactStage {
  ContactDetector detector;
  ContactOptions options;
  std::vector<Contact> contacts;   // of this frame, on every rank
  ContactSet set;                  // those that this rank evaluates
  std::vector<Vec3> reaction;      // (set.items.size()) of the last substep [N]
  std::vector<Vec3> reaction_sum;  // over the substeps of this frame
  std::vector<ToolMotion> motion;  // (n_tools) at the present substep
};

struct FrameSpan {
  double t0 = 0, t1 = 0;  // [s]
  double dt = 0;          // of a substep [s]
  std::int64_t n_substeps = 1;
};

// Finds the contacts of the frame. reach_extra: how far tissue may move towards a tool within a
// frame [m].
void detect_contacts(ContactStage& stage, std::span<const Tool> tools, const Holds& holds,
                     const SurfaceView& view, const FrameSpan& span, double reach_extra);
void prepare_frame_contacts(ContactStage& stage, const Part& part, std::span<const double> mass,
                            double dt);

// Poses and velocities of all tools at time t (velocity over the substep before).
void move_tools(std::span<const Tool> tools, double t, double dt, std::span<ToolMotion> motion);
void add_contact_reactions(ContactStage& stage);
// Mean over the frame, added to force (n_tools), exact in any order.
void sum_contact_reactions(ContactStage& stage, std::int64_t n_substeps,
                           std::span<std::array<ExactSum, 3>> force);

}  // namespace trocar
