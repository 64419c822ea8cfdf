// Contact within a frame: the pairs of tool and tissue that may meet are found once at its
// beginning, and looked at anew in every substep.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision/contact_solve.h"
#include "collision/detector.h"
#include "engine/frame_span.h"
#include "engine/holds.h"
#include "engine/surface_view.h"
#include "engine/tool.h"
#include "engine/tool_load.h"
#include "solver/mass_scaling.h"

namespace trocar {

// The last look for tissue that may meet tissue, in the order of SurfaceView::local: how far the
// tissue has come since from where its velocities would have taken it says when the next is due.
struct PairLook {
  double time = 0;              // [s]
  std::vector<double> u, v;     // (n * 3) there [m], [m/s]
  std::int64_t next_check = 0;  // substep of the frame
  // (n_nodes) Of SurfaceView: that of the frame's beginning, during a look within the frame.
  std::vector<Vec3> view_x, view_v;
};

// M of solver/mass_scaling.h against forces, for ContactInertia: of a cluster with D = m + d the
// share of a node is d / D. Empty where no masses are scaled.
struct JoinedMasses {
  std::vector<double> mass, share;    // (n_nodes)
  std::vector<std::int32_t> cluster;  // (n_nodes)
};

struct ContactStage {
  ContactDetector detector;
  ContactOptions options;
  bool has_tissue = false;         // tissue touches tissue, too
  std::vector<Contact> contacts;   // of this frame, on every rank
  std::vector<TissuePair> tissue;  // the same of tissue and tissue
  std::vector<Vec3> ahead;         // (n_nodes) surface nodes at the end of the frame, if free [m]
  PairLook look;
  JoinedMasses joined;
  std::vector<FixedMask> held;  // (n_nodes) in this frame; empty until there are contacts
  std::vector<Vec3> yield;      // (n_clusters) of ContactInertia, with `held`
  ContactSet set;               // those that this rank works on
  std::vector<double> u_next;   // (n_local * 3) of its owned nodes, without contact [m]
  std::optional<HaloExchange> exchange;
  std::vector<double> positions;   // (set.node.size() * 6) that travel
  std::vector<ToolMotion> motion;  // (n_tools) at the end of the substep
};

// Finds the contacts of the frame. reach_extra: how far tissue may move towards a tool within a
// frame [m].
void detect_contacts(ContactStage& stage, std::span<const Tool> tools, const Holds& holds,
                     const SurfaceView& view, const FrameSpan& span, double reach_extra);
// The same of tissue and tissue; time: of the frame [s], reach: how much nearer tissue may come
// than its velocities say [m].
void detect_tissue(ContactStage& stage, const SurfaceView& view, double time, double reach);
// Of a rank's part of the mesh; global fields (n_nodes).
struct ContactBody {
  const Part& part;
  std::span<const std::int32_t> node_owner;
  std::span<const double> mass;          // [kg]
  std::span<const std::uint8_t> fixed;   // supported components
  const MassScaling* scaling = nullptr;  // null: no masses are scaled
};
// Where masses are scaled: after build and each edit, before frames are prepared.
void join_masses(ContactStage& stage, const ContactBody& body);
// What graspers and supports hold, in the components in which they do, doesn't yield to contact.
void prepare_frame_contacts(ContactStage& stage, const ContactBody& body, const Holds& holds);
// The same after another look for tissue within the frame.
void renew_frame_contacts(ContactStage& stage, const ContactBody& body, const Holds& holds,
                          const Communicator& communicator);
// Positions of the set's nodes from their displacements before a step (n_local * 3) and u_next, on
// all ranks that work on them. Collective among these. X (n_nodes).
void share_positions(ContactStage& stage, std::span<const Vec3> X, std::span<const double> u,
                     Communicator& communicator);

// Of the last step, to the nodes of this rank: force (n_owned * 3).
void add_contact_force(const ContactStage& stage, std::span<double> force);

// Poses and velocities of all tools at time t (velocity over the substep before).
void move_tools(std::span<const Tool> tools, double t, double dt, std::span<ToolMotion> motion);
// Mean over the frame, added to loads (n_tools).
void sum_contact_reactions(const ContactStage& stage, std::int64_t n_substeps,
                           std::span<ToolLoad> loads);

}  // namespace trocar
