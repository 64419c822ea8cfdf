// What each frame told: the rows of the metrics and the numbers of the summary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "mesh/edit.h"

namespace trocar {

struct ToolRow {
  Vec3 position = Vec3::Zero();  // of the tip [m]
  Vec3 force = Vec3::Zero();     // of the tissue on the tool, mean over the frame [N]
  Vec3 torque = Vec3::Zero();    // and about the tip; with metrics [N m]
  Vec3 pull = Vec3::Zero();      // of what it holds alone; no checkpoint has it [N]
};

// Energy that a body holds. [J]
struct EnergyState {
  double kinetic = 0, strain = 0, hourglass = 0;
  double gravity = 0;  // -sum m g·u
  double sum() const { return kinetic + strain + hourglass + gravity; }
};

// Work done on the body since the start. [J]
struct EnergyWorks {
  double contact = 0;  // instruments that touch it, and tissue that touches tissue
  double holds = 0;    // grasped nodes and moving supports
  double blade = 0;    // the resistance to blades
  double loads = 0;
  double damping = 0;  // mass-proportional damping; not positive
  // What relaxation adds to the laws' stress. Strain energy is that of the laws alone: loading what
  // has relaxed stores more of it than the load does work, and this is the difference; around a
  // cycle it is what viscosity takes, negative.
  double viscous = 0;
  double cut = 0;  // change of the energy held at edits of the mesh
  double sum() const { return contact + holds + blade + loads + damping + viscous + cut; }
};

struct FrameRow {
  std::int64_t frame = 0, step = 0, n_substeps = 0;
  double time = 0, dt = 0, stable_step = 0;  // [s]
  double least_J = 1;
  double asleep = 0;  // share of the nodes after the frame
  // Only with a metrics output [J]; what is held = what was held at the start + works + error.
  EnergyState energy;
  EnergyWorks works;
  double energy_error = 0;
  double wound_width = 0, wound_width_mean = 0;  // [m] distance of partner nodes, largest and mean
  std::int64_t n_contacts = 0;                   // of instruments
  std::int64_t n_tissue_contacts = 0;            // of tissue with tissue
  std::int64_t n_held = 0, n_edits = 0, n_pieces = 1;
  std::vector<ToolRow> tools;
  std::vector<Vec3> markers;         // positions; with metrics [m]
  std::vector<Vec3> support_forces;  // of the tissue on each, mean over the frame; with metrics [N]
  double seconds = 0;                // wall time of the frame up to its outputs
  double latency = 0;                // and with its outputs and checkpoint, without waiting
};

// For the highest frequency, after what a frame has shown.
struct Searches {
  std::int64_t n_of_body = 0, n_of_parts = 0;
};

// How the body came to rest before the first frame.
struct Equilibrium {
  std::int64_t iterations = 0;  // 0: it was not sought
  double residual = 0;          // see Relaxation
  double seconds = 0;
};

// Of events that are told once a run.
struct ToldOnce {
  bool no_local_steps = false, sunk_tissue = false;
};

// Of all frames together.
struct RunTally {
  Equilibrium equilibrium;
  std::int64_t n_roll_backs = 0;
  std::int64_t n_deadlines_missed = 0;
  Searches searches;
  double least_J = 1;
  std::int32_t least_J_element = -1;
  ToldOnce told;
  double least_stable_step = 0, largest_stable_step = 0;
  std::vector<std::string> events;  // "1.20 s: grasper closes on 31 nodes"
};

struct FrameLog : RunTally {
  std::vector<FrameRow> rows;
  std::vector<MeshEdit> new_edits;  // of this frame
};

// Those that have gone by as checkpoints write them (checkpoint_bytes.cpp).
struct PackedRows {
  std::ptrdiff_t n = 0;
  std::vector<std::vector<std::byte>> blobs;
};

}  // namespace trocar
