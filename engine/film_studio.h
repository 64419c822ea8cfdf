// Draws the frames of all picture outputs in a thread of its own, while the next frame is computed.
// Rank 0 only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/scene.h"
#include "engine/tool.h"
#include "mesh/facets.h"

namespace trocar {

// A picture that a scene asks for.
struct FilmOrder {
  OutputKind kind = OutputKind::video;
  std::string file;  // full path; frames: a folder
  SceneCamera camera;
  int width = 1280, height = 720;
  double frame_rate = 30;  // of a video [1/s]
};

// Whether any of the points is in the picture.
bool is_in_view(const FilmOrder& order, std::span<const Vec3> x);

// All that a frame's picture needs, copied out of the simulation.
struct FilmFrame {
  std::int64_t number = 0;  // of the frame
  double time = 0;          // [s]
  std::vector<Vec3> x, X;   // (n_nodes)
  Surface surface;
  std::vector<std::int32_t> region;  // (n_triangles) behind each triangle; or empty: all 0
  std::vector<std::size_t> orders;   // which orders it is drawn for
};
std::vector<std::int32_t> surface_regions(const Mesh& mesh, const Surface& surface);

class FilmStudio {
 public:
  // Of a body of this mesh. Tools are drawn at their path. Throws MachineError if the renderer or
  // ffmpeg can't be started.
  FilmStudio(std::vector<FilmOrder> orders, const SceneTissue& tissue, const Mesh& mesh,
             std::vector<Tool> tools);
  ~FilmStudio();  // finishes, if that has not been done
  // Waits while two frames are under way. Throws what went wrong in the thread.
  void add(FilmFrame frame);
  // Until all picture files of what was added are there, which a resumed run does not draw again.
  // Throws what went wrong in the thread.
  void wait_for_pictures();
  void finish();
  double seconds() const;        // of drawing, so far
  std::int64_t n_drawn() const;  // pictures, so far; orders may share one. For tests

 private:
  struct Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace trocar
