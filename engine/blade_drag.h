// The resistance of tissue to blades, like dry friction at the nodes around the edge: at most
// [cutting] resistance for each length of edge inside, and never so much that tissue would get
// ahead of the blade. Without that bound the few nodes at which a blade enters would be thrown
// forward.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "engine/locate.h"
#include "engine/tool_load.h"
#include "mesh/mesh.h"
#include "mesh/partition.h"
#include "solver/step.h"

namespace trocar {

// Where an edge is inside tissue.
struct EngagedEdge {
  std::int32_t tool = 0;
  std::span<const SegmentPiece> piece;
  Vec3 velocity = Vec3::Zero();         // of the edge's middle [m/s]
  Vec3 tissue_velocity = Vec3::Zero();  // around it [m/s]
};

struct BladeDrag {
  struct Node {
    std::int32_t local = 0;  // owned
    std::int32_t tool = 0;
    double most = 0;                // [N]
    double speed = 0;               // of the blade along `direction` [m/s]
    Vec3 direction = Vec3::Zero();  // of the blade's motion in the tissue
    double force = 0;               // of the last step [N]
    double force_sum = 0;           // over the steps of this frame [N]
    Vec3 arm = Vec3::Zero();        // from the tool's tip, at the frame's begin [m]
  };
  std::vector<Node> node;  // of this rank, ascending (tool, local)
};

// Of the blade's motion in the tissue; in tissue that goes along with it, of its own. Zero if both
// rest.
Vec3 direction_of(const EngagedEdge& edge);

// Adds the owned nodes around an edge. resistance [N/m].
void add_engaged_edge(const EngagedEdge& edge, const Mesh& mesh, const Part& part,
                      double resistance, BladeDrag& drag);

// Adds to the force of owned nodes what holds in this step.
void add_drag(const Model& model, const State& state, double dt, BladeDrag& drag,
              std::span<double> force);

// What the tissue does to each tool, mean over n substeps; adds to loads (n_tools).
void sum_drag_reactions(const BladeDrag& drag, std::int64_t n_substeps, std::span<ToolLoad> loads);

}  // namespace trocar
