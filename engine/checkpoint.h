// A run at the end of a frame, as data in global numbers: all that the next frame depends on, and
// what the summary and the metrics tell of the frames before. What follows from the scene (tools,
// paths) or from the mesh (model, partition, surface) is not in it but built again.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/bytes.h"
#include "engine/simulation.h"

namespace trocar {

// Of a CutStage, what it keeps from frame to frame.
struct CutMemory : CutProgress {
  CutStroke stroke;
};

// Of a recording, how far it has come, or of metrics, that there were some.
struct OutputMark {
  OutputKind kind = OutputKind::recording;
  std::string file;               // as the scene names it
  std::int64_t last_frame = 0;    // recorded, 0: none
  std::vector<MeshEdit> pending;  // edits since then
};

struct Checkpoint {
  std::string version, simd;   // of the program and of its kernels: bits are promised for the same
  std::string scene;           // effective scene, TOML
  std::uint32_t body_crc = 0;  // Simulation::body_crc
  std::int64_t frame = 0;
  std::uint64_t digest = 0;  // state_digest

  // The simulation's own in what take_checkpoint makes: to be written before that changes.
  std::shared_ptr<const Mesh> mesh;
  std::vector<FixedMask> fixed;                                // (n_nodes)
  std::vector<std::int32_t> duplicate_parent, duplicate_node;  // partner nodes
  std::vector<double> u, v;                                    // (n_nodes * 3) [m], [m/s]
  double time = 0, last_dt = 0;
  std::int64_t step = 0;
  double step_scale = 1, held_step = 0, held_by_contact = 0;
  Watch watch;
  std::vector<Hold> holds;
  std::vector<std::uint8_t> is_open;  // (n_tools)
  std::vector<CutMemory> cuts;        // one an instrument that cuts
  RunTally tally;
  std::shared_ptr<const std::vector<FrameRow>> rows;  // as the mesh
  std::vector<double> history;  // of viscoelastic elements, see solver/history.h
  double history_time = 0;
  SearchMemory searches;
  std::vector<double> looked_at;  // ElementLook::u (n_nodes * 3), or empty
  bool has_stiffening = false;
  LocalStepVerdict local_steps = LocalStepVerdict::none;
  std::vector<double> sleep;  // gather_sleep, empty: nothing ever sleeps
  QuietRange quiet_range;
  bool has_energies = false;
  EnergyMemory energy;
  std::vector<OutputMark> outputs;
};

// Of everything but the outputs; fields of nodes, history and strokes on the root alone.
// Collective.
Checkpoint take_checkpoint(Simulation& s);
// Puts a simulation that was built from the same scene where the checkpoint was taken. Collective;
// throws InputError on every rank if body and checkpoint don't belong together.
void restore_checkpoint(const Checkpoint& checkpoint, Simulation& s);

// What a frame changes before its substeps have gone well: a run that fails within a frame keeps
// the frame's beginning.
struct FrameStart {
  std::int64_t step = 0;  // of the state
  Watch watch;
  double step_scale = 1;
  std::vector<Hold> holds;
  std::vector<std::uint8_t> is_open;
  ElementLook look;
  std::optional<SleepRoll> sleep;
  LocalStepVerdict local_steps = LocalStepVerdict::none;
  std::size_t n_events = 0;
  ToldOnce told;
  std::int64_t n_roll_backs = 0;
  Searches searches;
};
FrameStart start_of_frame(const Simulation& s);
// Of a simulation whose frame failed: its state is back at the frame's beginning, and so is the
// rest of the checkpoint. Collective.
Checkpoint take_checkpoint_of_start(Simulation& s, const FrameStart& start);

// Packed, with checksums that find every flipped byte (checkpoint_bytes.cpp); the first hands on
// piece by piece. packed: by earlier checkpoints of the run, so that each row is packed once.
void put_checkpoint(const Checkpoint& checkpoint, PackedRows& packed, const ByteSink& sink);
// Throws InputError "<name>: …" for damaged bytes or another format.
Checkpoint checkpoint_from_bytes(std::span<const std::byte> bytes, const std::string& name);

}  // namespace trocar
