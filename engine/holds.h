// Nodes whose motion is given: held by a grasper, or a support that moves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/communicator.h"
#include "engine/tool.h"
#include "engine/tool_load.h"
#include "mesh/edit.h"
#include "mesh/partition.h"
#include "solver/step.h"

namespace trocar {

// A node held by tool `tool` at `offset` in the tool's frame, or moved by support `support` of the
// scene. [m]
struct Hold {
  std::int32_t node = 0;  // global
  std::int32_t tool = -1;
  std::int32_t support = -1;
  Vec3 offset = Vec3::Zero();
};

struct Holds {
  std::vector<Hold> holds;                 // ascending node, a node once
  std::vector<DisplacementPath> paths;     // (n_supports) none of supports at rest
  std::vector<std::int32_t> owned;         // positions in `holds` of this rank's nodes
  std::vector<PrescribedNode> prescribed;  // (owned.size())
  std::vector<Vec3> reaction_sum;          // (owned.size()) over the substeps of this frame [N]
  std::vector<Pose> poses;                 // (n_tools) at the end of the substep
  std::vector<std::uint8_t> is_open;       // (n_tools) last action done was not `close`
};

// For each node (n_nodes) that is held by anything, or supported in a component in which not all
// nodes are, 1 or, if supports leave it some, `may_slide`.
std::vector<std::uint8_t> held_nodes(const Holds& holds, std::span<const std::uint8_t> fixed);
// 1 for each node that is held or supported in all components: jaws can't take it, and nothing that
// an edit restores moves it. What a mirror plane supports goes along in the others.
std::vector<std::uint8_t> immovable_nodes(const Holds& holds, std::span<const std::uint8_t> fixed);
// The same of one node; of a body before an edit, also of one that the edit will make.
bool is_immovable(const Holds& holds, std::span<const std::uint8_t> fixed, std::int32_t node,
                  const MeshEdit& edit = {});

// A grasper or scissors whose key it is to act.
struct DueAct {
  const InstrumentKey* key = nullptr;
  std::int32_t tool = 0;
};
// Those whose time lies in (t0, t1], in the order of their times; of those at one time what opens
// comes first, so that tissue can be handed over.
std::vector<DueAct> due_acts(std::span<const Tool> tools, double t0, double t1);
bool does_grasper_close(std::span<const DueAct> due, std::span<const Tool> tools);

// What a grasper did: closed on so many nodes, or opened.
struct GraspAct {
  std::int32_t tool = 0;
  bool has_closed = false;
  int n_taken = 0;
  double nearest = 0;  // distance of the nearest node that nothing else holds from its tip,
                       // infinity if there is none [m]
};
// What graspers close on.
struct BodyToGrasp {
  double time = 0;                      // at which tools are where they act
  std::span<const Vec3> x;              // (n_nodes) present positions, unless no grasper closes
  std::span<const std::uint8_t> fixed;  // (n_nodes)
};
// Closes and opens what is due. Nodes within the grip radius of the tip that nothing else holds are
// taken, in the components that no support holds. Returns what graspers did, one after the other.
std::vector<GraspAct> act_graspers(Holds& holds, std::span<const Tool> tools,
                                   std::span<const DueAct> due, const BodyToGrasp& body);
// The longest way in [t0, t1] of anything within the grip radius of the tip. [m]
double grip_travel(const Tool& tool, double t0, double t1);
// The longest way in [t0, t1] of what moves as it is told: of supports, and of all within the grip
// radius of the tip of graspers that hold something. [m]
double largest_travel(const Holds& holds, std::span<const Tool> tools, double t0, double t1);
// Lets go of all that the tool holds: how many nodes.
int release(Holds& holds, std::int32_t tool);

// Of a node; null: nothing holds it.
const Hold* find_hold(std::span<const Hold> holds, std::int32_t node);

// After a change of part, holds or topology.
void localise_holds(Holds& holds, const Part& part);
// A partner of a held node is held too, at the same offset, and a node on an edge between two that
// are held by the same.
void apply_edit_to_holds(const MeshEdit& edit, std::int32_t n_nodes_before, Holds& holds);

// Targets at the end of the substep. X (n_nodes).
void aim_holds(Holds& holds, std::span<const Tool> tools, std::span<const Vec3> X, double time);
// After integrate: adds the reactions to reaction_sum.
void add_hold_reactions(Holds& holds);
// Of a frame that is done again.
void forget_hold_reactions(Holds& holds);
// What the tissue does to each tool and moving support through its holds, mean over n substeps;
// adds to on_tool (n_tools) and on_support (n_supports), exact in any order.
void sum_hold_reactions(Holds& holds, std::int64_t n_substeps, std::span<ToolLoad> on_tool,
                        std::span<ExactSum3> on_support);

}  // namespace trocar
