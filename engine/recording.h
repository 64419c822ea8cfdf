// A recording: one SQLite file that holds the scene, the mesh, every change of its topology and the
// displacements frame by frame, so that any frame can be shown again without simulating. database.h
// has SQLite, blob.h the packing. Blobs are byte-shuffled doubles, zstd level 1, each with a CRC32C
// of the plain bytes, and each row has one of its other values; one transaction a frame, WAL,
// exclusive locking.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/edit.h"
#include "mesh/mesh.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

// What a recording begins with.
struct RecordingHead {
  std::string version;  // of the program
  std::string scene;    // effective scene, TOML
  Mesh mesh;            // at time zero
  // The user's own tool surfaces, one a tool, empty where built in.
  std::vector<TriangleMesh> tool_meshes;
};

struct RecordedFrame {
  std::int64_t frame = 0, step = 0;
  double time = 0;                  // [s]
  std::uint64_t digest = 0;         // of the state
  std::vector<double> u;            // (n_nodes * 3) [m]
  std::vector<double> tool_forces;  // (n_tools * 3) [N]
};

class RecordingWriter {
 public:
  // Replaces a file of that name. Throws MachineError with path and reason (here and below: full
  // disk, …).
  RecordingWriter(const std::string& file, const RecordingHead& head);
  // Goes on with a recording: drops all that follows `last_frame` (0: every frame), which must be
  // there.
  RecordingWriter(const std::string& file, std::int64_t last_frame);
  ~RecordingWriter();
  RecordingWriter(RecordingWriter&&) noexcept;
  // The edits since the last frame, then the frame: one transaction. After it returns the frame
  // survives a kill.
  void add(std::span<const MeshEdit> edits, const RecordedFrame& frame);
  // Returns when all that was added is on the disk, safe from a loss of power too.
  void sync();
  // The end of the run: says in the file that this is all, and leaves a single file. Call once,
  // last.
  void finish();

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

class RecordingReader {
 public:
  // Throws InputError if the file is missing, no recording, or damaged at its head.
  explicit RecordingReader(const std::string& file);
  ~RecordingReader();
  RecordingReader(RecordingReader&&) noexcept;
  const RecordingHead& head() const;
  // (frame, time) of all recorded frames that can be trusted, ascending.
  const std::vector<std::pair<std::int64_t, double>>& frames() const;
  // A sentence for each frame that is missing from frames() because it is damaged or gone; empty
  // for a sound recording, also a killed run's.
  const std::vector<std::string>& damage() const;
  // Throws InputError "frame 17: …" for a damaged one or one that is not recorded; other frames
  // stay readable.
  RecordedFrame read(std::int64_t frame);
  // The mesh as it was in this recorded frame: the first mesh with all edits up to it applied.
  // Valid until the next call. Throws as read does.
  const Mesh& mesh_at(std::int64_t frame);
  // In the mesh that mesh_at gave last.
  std::int64_t n_edits() const;

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace trocar
