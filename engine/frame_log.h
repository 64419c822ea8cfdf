// What each frame told: the rows of the metrics and the numbers of the summary.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "mesh/edit.h"

namespace trocar {

struct ToolRow {
  Vec3 position = Vec3::Zero();  // of the tip [m]
  Vec3 force = Vec3::Zero();     // of the tissue on the tool, mean over the frame [N]
};

struct FrameRow {
  std::int64_t frame = 0, step = 0, n_substeps = 0;
  double time = 0, dt = 0, stable_step = 0;  // [s]
  double least_J = 1;
  double kinetic = 0, strain = 0, hourglass = 0;  // [J], only with a metrics output
  double wound_width = 0, wound_width_mean = 0;   // [m] distance of partner nodes, largest and mean
  std::int64_t n_contacts = 0, n_held = 0, n_edits = 0;
  std::vector<ToolRow> tools;
  double seconds = 0;  // wall time of the frame without waiting
};

// An edit as the recording needs it: in front of which frame it happened.
struct FrameEdit {
  std::int64_t frame = 0;
  MeshEdit edit;
};

struct FrameLog {
  std::vector<FrameRow> rows;
  std::vector<FrameEdit> new_edits;  // of this frame
  std::int64_t n_roll_backs = 0;
  std::int64_t n_deadlines_missed = 0;
  double least_J = 1;
  std::int32_t least_J_element = -1;
  double least_stable_step = 0, largest_stable_step = 0;
  std::vector<std::string> events;  // "1.20 s: grasper closes on 31 nodes"
};

}  // namespace trocar
