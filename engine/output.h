// Everything that a run writes. Which output is due is known on every rank; rank 0 writes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/frame_log.h"
#include "engine/metrics_file.h"
#include "engine/recording.h"
#include "engine/scene.h"

namespace trocar {

struct Checkpoint;
struct Simulation;
class FilmStudio;

// The writers exist on rank 0 only, each of its kind of output.
struct OutputSlot {
  OutputKind kind = OutputKind::metrics;
  std::string file;               // full path
  std::int64_t interval = 1;      // [frames]
  std::int64_t n_frames = 0;      // of the whole run
  std::int64_t last_frame = 0;    // of a recording: the last one in it, 0 none
  std::vector<MeshEdit> pending;  // of a recording: edits since then
  bool is_continued = false;      // a recording or metrics that a stopped run began
  std::unique_ptr<MetricsFile> metrics;
  std::unique_ptr<RecordingWriter> recording;
  std::size_t film = 0;  // of a picture: its place among the studio's orders
  // Of a contact sheet only the frames that it shows.
  bool is_due(std::int64_t frame) const;
};

struct Outputs {
  std::string folder;
  std::int64_t last_checkpoint = -1;  // its frame
  PackedRows rows_in_checkpoints;
  std::vector<OutputSlot> slots;
  std::unique_ptr<FilmStudio> studio;  // on rank 0, of all pictures

  Outputs();
  ~Outputs();
  Outputs(Outputs&&) noexcept;
};

// Throws MachineError if nothing can be written there.
void make_output_folder(const std::string& folder);
// Makes the folder, puts the scene's `echo` there if there is one and opens all files. Collective;
// throws MachineError on every rank if the folder can't be written. resumed: where the run goes on,
// null at time zero: recordings and metrics are cut off there and go on, films and contact sheets
// get files of their own. Throws InputError on every rank if a recording is not what the checkpoint
// says.
Outputs open_outputs(Simulation& s, const std::string& folder, const std::string& echo,
                     const Checkpoint* resumed);
// Collective; throws SharedMachineError on every rank if something can't be written.
void write_outputs(Simulation& s, Outputs& outputs, const FrameRow& row);
// Waits for encoders and closes files. Throws MachineError on rank 0.
void finish_outputs(Outputs& outputs);
// True if what is told of frame s.frame, which is just done, or contact in the next one looks at
// surface positions.
bool needs_surface(const Simulation& s, const Outputs& outputs);

}  // namespace trocar
