// An instrument of the scene: its path, its shape for contact, its look, its cutting edge.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/box.h"
#include "collision/tool_shape.h"
#include "engine/scene.h"
#include "engine/tool_path.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

// A rigid piece of the picture; jaws turn about the hinge.
struct ToolPart {
  TriangleMesh surface;  // in the tool's frame, jaws in closed position
  int jaw = 0;           // 0: fixed to the shaft; +1, -1: jaws
};

inline constexpr std::size_t no_piece = std::numeric_limits<std::size_t>::max();

struct Tool {
  InstrumentKind kind = InstrumentKind::probe;
  std::string name;
  ToolPath path;
  std::vector<InstrumentKey> keys;
  ToolShape shape;
  Box box;  // round the shape, in the tool's frame [m]
  std::vector<ToolPart> parts;
  TriangleMesh own_mesh;  // the user's surface, empty where the shape is built in
  // Scalpel: the straight cutting edge, from the tip up, in the tool's frame [m]. Scissors: the
  // line from blade to blade through the tips when open; cutting_edge() takes it towards the pivot.
  std::vector<Vec3> edge;
  double grip_radius = 0;     // grasper [m]
  double grip_force = 0;      // that it holds, 0: any [N]
  double hinge_height = 0;    // jaws turn about the y axis here [m]
  double closed_share = 0.1;  // of the angle of open jaws that is left when they are closed
  // Of the working pieces of the shape those before open_end touch while the jaws are open, those
  // from closed_begin on while they are closed.
  std::size_t open_end = no_piece, closed_begin = no_piece;
  // As deep in closed jaws tissue lies between them, and does not touch. [m]
  double caught = std::numeric_limits<double>::infinity();
};

// Shape index of the first piece that closes with the jaws (grasper) / of the blade (scalpel);
// pieces before it belong to the shaft.
inline constexpr int first_working_piece = 1;

// Of the instrument [m]: a shaft that ended short of its blade or jaws would lie across them.
double least_length(const SceneInstrument& instrument);
// At least as long. mesh: a surface of the user's for the tip, empty for the built-in one.
// edge_spacing: distance of the points of a cutting edge [m].
Tool make_tool(const SceneInstrument& instrument, const TriangleMesh& mesh, double edge_spacing);

// Jaws take this time to close or to open. [s]
inline constexpr double jaw_time = 0.2;
// How far the jaws are open at a time, 1 open … 0 closed; they have moved at the keys.
double jaw_opening(const Tool& tool, double time);
// Pose of a part: the tool's, with a jaw's turn.
Pose part_pose(const Tool& tool, const ToolPart& part, double time);

// True for a scalpel, and for scissors while they close between the two times.
bool is_cutting(const Tool& tool, double t0, double t1);
// Present positions of the edge at which the tool cuts; the same count of points at any time. [m]
// Scissors: across the open wedge in the plane of the blades, where these cross as they close: the
// crossing goes from near the pivot to the tips.
std::vector<Vec3> cutting_edge(const Tool& tool, double time);

}  // namespace trocar
