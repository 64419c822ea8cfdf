// A scene as the user wrote it: plain structs, in SI, every default visible. scene_options.cpp
// declares the keys.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "base/vec.h"
#include "engine/scene_material.h"
#include "mesh/generate.h"
#include "solver/formulation.h"

namespace trocar {

enum class Pace { fast, real_time };
// What follows from a frame that misses its deadline.
enum class Overrun { catch_up, shift, stop };
enum class ShapeKind { box, ball, cylinder, rectangle, triangular_rectangle };
enum class InstrumentKind { probe, grasper, scalpel, scissors };
extern const std::vector<std::pair<std::string, InstrumentKind>> instrument_kinds;  // in its order
inline bool has_blade(InstrumentKind kind) {
  return kind == InstrumentKind::scalpel || kind == InstrumentKind::scissors;
}
enum class GraspAction { none, close, open };
enum class OutputKind { video, frames, recording, metrics, contact_sheet };
inline bool is_picture(OutputKind kind) {
  return kind != OutputKind::metrics && kind != OutputKind::recording;
}
enum class CutMode { robust, paper };

struct SceneTime {
  double duration = 1;     // [s]
  double frame_rate = 30;  // [1/s]
  Pace pace = Pace::fast;
  Overrun overrun = Overrun::catch_up;

  // When a frame begins, and how long so many take. [s]
  double at(std::int64_t frame) const { return static_cast<double>(frame) / frame_rate; }
  // Frames in so many seconds, to the nearest.
  std::int64_t frames_in(double seconds) const {
    return std::llround(std::min(seconds * frame_rate, 1e15));
  }
  // Between two of what is done every so many seconds.
  std::int64_t interval(double seconds) const {
    return std::max<std::int64_t>(1, frames_in(seconds));
  }
  std::int64_t n_frames() const { return frames_in(duration); }
  // Frames come one after the other, as fast as they can.
  void forget_deadlines() {
    pace = Pace::fast;
    overrun = Overrun::catch_up;
  }
};

// How the tissue of a region looks, linear RGB; what is not given (NaN) is the tissue's.
struct SceneRegionLook {
  Vec3 colour = Vec3::Constant(SceneMaterial::absent);
  Vec3 cut_colour = colour;
};

// Elements of this region of the mesh are made of something else.
struct SceneRegionMaterial {
  std::string region;
  SceneMaterial material;
  std::optional<SceneRegionLook> look;  // none: that of the tissue
};

struct SceneShape {
  ShapeKind kind = ShapeKind::box;
  BoxElements elements = BoxElements::hex8;
  Vec3 low = Vec3::Zero(), high{0.1, 0.1, 0.1};  // box and rectangle
  Vec3 centre = Vec3::Zero();                    // ball, cylinder (of its base)
  double radius = 0.05, height = 0.1;
  std::array<int, 3> cells{10, 10, 10};
};

struct SceneLook {
  Vec3 colour{0.42, 0.10, 0.08};
  Vec3 cut_colour{0.62, 0.20, 0.17};
  double wetness = 0.7;
  double texture_size = 0.012;
  bool has_edges = false;
};

struct SceneTissue {
  std::string mesh;
  double scale = 1;
  bool is_renumbered = true;
  double longest_side = 0;  // 0: as in the file
  bool is_centred = false;
  Vec3 translate = Vec3::Zero();
  std::optional<SceneShape> shape;
  SceneMaterial material;
  std::vector<SceneRegionMaterial> region_materials;
  double thickness = 1e-3;
  SceneLook look;
};

// Whether any material of the body is so.
template <class Is>
bool any_material(const SceneTissue& tissue, const Is& is) {
  return is(tissue.material) ||
         std::ranges::any_of(tissue.region_materials,
                             [&](const SceneRegionMaterial& other) { return is(other.material); });
}

// Where the time step comes from: bounds of each element, or the body's highest frequency.
enum class StableStep { element_bound, frequency };

struct SceneSolver {
  Vec3 gravity = Vec3::Zero();
  double mass_damping = 0;
  double hourglass = 0.15;
  double step_factor = std::numeric_limits<double>::quiet_NaN();  // not given: step_factor_of
  StableStep stable_step = StableStep::frequency;
  double mass_scaling_step = 0;  // [s], 0: none
  double sleep = 0;              // [m], 0: never
  bool is_multirate = false;
  Precision precision = Precision::in_double;
  Formulation triangle = Formulation::tri3_plane_strain;
  Formulation tetrahedron = Formulation::tet4;
  Formulation hexahedron = Formulation::hex8_one_point;
};

struct SceneContact {
  double friction = 0.2;
  double release_speed = 0.02;  // [m/s]
  bool has_tissue = false;
};

struct SceneCutting {
  double advance = 0.5;
  double least_step_ratio = std::numeric_limits<double>::quiet_NaN();  // not given
  double split_step_ratio = 0.35;                                      // 0: no element is split
  double resistance = 0;  // force per length of engaged edge [N/m]
  CutMode mode = CutMode::robust;
  double spring = 1, particle = 0.1;
};

struct SceneCheckpoint {
  double every = 1;  // [s], 0: none
};

// What the body is like before the first frame.
enum class StartState { undeformed, equilibrium };

struct SceneStart {
  StartState state = StartState::undeformed;
  double tolerance = 3e-5;
  int max_iterations = 200000;
};

enum class RegionShape { box, ellipsoid };

struct SceneRegion {
  std::string name;
  RegionShape shape = RegionShape::box;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

struct SupportKey {
  double time = 0;
  Vec3 displacement = Vec3::Zero();
  bool stops = false;
};

struct SceneSupport {
  std::string region;
  std::string fix = "xyz";
  std::vector<SupportKey> path;
};

struct LoadKey {
  double time = 0;
  double factor = 1;
};

struct SceneLoad {
  std::string region;
  Vec3 force = Vec3::Zero();  // of the whole region [N]
  double pressure = 0;        // from outside [Pa]
  std::vector<LoadKey> path;
};

struct InstrumentKey {
  double time = 0;
  Vec3 position = Vec3::Zero();
  Vec3 direction{0, 0, -1};
  Vec3 forward{1, 0, 0};
  bool stops = false;
  GraspAction action = GraspAction::none;
};

struct SceneInstrument {
  InstrumentKind kind = InstrumentKind::probe;
  std::string name;
  double radius = 3e-3;
  double length = 0.15;
  double blade_length = 0.02;
  double grip_radius = 6e-3;
  double grip_force = 0;
  std::string mesh;
  double scale = 1;
  std::vector<InstrumentKey> path;
};

struct SceneMarker {
  std::string name;
  Vec3 position = Vec3::Zero();
};

struct SceneCamera {
  std::string name = "endoscope";
  Vec3 eye{0, -0.3, 0.2}, target = Vec3::Zero(), up{0, 0, 1};
  double field_of_view = 0.9;
  bool has_endoscope_mask = false;
};

struct SceneOutput {
  OutputKind kind = OutputKind::metrics;
  std::string file;
  std::string camera;
  std::array<int, 2> size{1280, 720};
  double every = 0;  // [s], 0: every frame
};

struct Scene {
  std::string name = "scene";
  SceneTime time;
  SceneTissue tissue;
  SceneSolver solver;
  SceneContact contact;
  SceneCutting cutting;
  SceneStart start;
  SceneCheckpoint checkpoint;
  std::vector<SceneRegion> regions;
  std::vector<SceneSupport> supports;
  std::vector<SceneLoad> loads;
  std::vector<SceneInstrument> instruments;
  std::vector<SceneMarker> markers;
  std::vector<SceneCamera> cameras;
  std::vector<SceneOutput> outputs;
};

// Whether an instrument of the scene cuts.
bool has_blades(const Scene& scene);
// Whether anything of the scene is written to a table of metrics.
bool has_metrics(const Scene& scene);
// The one given, or what keeps below resonances of the scheme (docs/stability.md): that of three
// steps, and in plane stress, where what springs back stiffens manyfold, that of four.
double step_factor_of(const SceneSolver& solver, const Mesh& mesh);
// The first one for "", null if there is none.
const SceneCamera* find_camera(const Scene& scene, const std::string& name);

Options<Scene> scene_options();

// Reads and checks a scene, also what one key alone can't tell: names that refer to each other,
// times that ascend, outputs that stay inside their folder. Throws InputError.
struct LoadedScene {
  Scene scene;
  SourceMap where;
  std::string folder;  // of the scene file; relative mesh paths start here
};
LoadedScene load_scene(const std::string& file, const std::vector<std::string>& overrides);
// The path of a file that the scene names: relative ones start at the scene file's folder.
inline std::string scene_path(const LoadedScene& loaded, const std::string& file) {
  return file.starts_with('/') ? file : loaded.folder + file;
}

}  // namespace trocar
