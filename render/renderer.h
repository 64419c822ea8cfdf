// Off-screen pictures of tissue and instruments as an endoscope sees them. The headers of
// OSMesa and OpenGL are seen by gl_*.h and gl_*.cpp alone; libOSMesa is loaded (dlopen) when the
// first renderer is made, never before.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/timers.h"
#include "base/vec.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

struct Camera {
  Vec3 eye{0, -0.3, 0.2};
  Vec3 target = Vec3::Zero();
  Vec3 up = Vec3::UnitZ();
  double field_of_view = 0.9;       // vertical [rad]
  bool has_endoscope_mask = false;  // round picture on black, light at the tip
};

// Linear RGB in [0, 1].
struct TissueColours {
  Vec3 outer{0.42, 0.10, 0.08};
  Vec3 cut{0.62, 0.20, 0.17};
};

struct TissueLook {
  std::vector<TissueColours> colours = {{}};  // of each region
  double wetness = 0.7;                       // [0, 1]
  double texture_size = 0.012;                // of the procedural pattern [m]
};

struct TissueView {
  std::span<const Vec3> x;  // (n_nodes) present positions
  std::span<const Vec3> X;  // (n_nodes) reference, anchors the texture
  std::span<const std::array<std::int32_t, 3>> triangle;  // outward
  std::span<const std::uint8_t> is_cut;                   // (n_triangles)
  std::span<const std::int32_t> region;                   // (n_triangles) or empty: all 0
  std::span<const std::uint8_t> is_quad_half;             // (n_triangles) or empty, see mark_edges
  TissueLook look;
  bool is_two_sided = false;  // plane meshes
  bool has_edges = false;     // draws the element edges
};

struct InstrumentView {
  const TriangleMesh* shape = nullptr;
  Pose pose;
  Vec3 colour{0.75, 0.76, 0.78};
};

struct SceneView {
  Camera camera;
  TissueView tissue;  // without triangles: none is seen
  std::vector<InstrumentView> instruments;
  std::string caption;  // drawn small in the lower left corner, empty: none
};

// 8-bit sRGB, rows top-down.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // (height * width * 3)
};

class Renderer {
 public:
  // Throws InputError if a side is not 1 to 8192, MachineError with a hint if OSMesa can't be
  // loaded or lacks memory.
  Renderer(int width, int height);
  ~Renderer();
  // Smooth vertex normals within a smooth sheet, split where outer surface and cut face meet. The
  // picture is the same for any number of threads.
  void draw(const SceneView& scene, Image& image);
  // Seconds so far: normals, upload, shadows, surfaces, post, read back.
  const PhaseTimers& timers() const;

 private:
  struct Gl;
  std::unique_ptr<Gl> gl_;
};

// True if libOSMesa can be loaded; `reason` says why not. For `trocar doctor`.
bool renderer_available(std::string& reason);

}  // namespace trocar
