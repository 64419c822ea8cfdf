// What one key alone can't tell: names that refer to each other, times that ascend, files that stay
// where they belong.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/scene.h"

namespace trocar {

namespace {

void check_tissue(const Scene& scene, const SourceMap& where) {
  const SceneTissue& tissue = scene.tissue;
  if (tissue.mesh.empty() == !tissue.shape)
    where.fail("tissue",
               "give either a mesh file (mesh = \"…\") or a generated body ([tissue.shape]), "
               "exactly one of them");
  if (tissue.shape && tissue.shape->kind == ShapeKind::box &&
      !(tissue.shape->low.array() < tissue.shape->high.array()).all())
    where.fail("tissue.shape", "each component of low must be below that of high");
}

bool is_viscoelastic(const SceneTissue& tissue) {
  return !tissue.material.prony.empty() ||
         std::any_of(
             tissue.region_materials.begin(), tissue.region_materials.end(),
             [](const SceneRegionMaterial& other) { return !other.material.prony.empty(); });
}

// A history of strains can't be left out, nor computed several times a step; the same with volume
// changes averaged over elements of which only some are computed again.
void check_shortcuts(const Scene& scene, const SourceMap& where) {
  const SceneSolver& solver = scene.solver;
  if (solver.sleep > 0 && is_viscoelastic(scene.tissue))
    where.fail("solver.sleep", "viscoelastic tissue (prony) can't sleep: leave out one of them");
  if (!solver.is_multirate) return;
  if (is_viscoelastic(scene.tissue) || solver.tetrahedron == Formulation::tet4_nodal_pressure ||
      solver.mass_scaling_step > 0 || solver.stable_step != StableStep::frequency)
    where.fail("solver.multirate",
               "it needs stable_step = \"frequency\" and none of prony, tetrahedron = "
               "\"nodal-pressure\", mass_scaling_step");
}

void complete_materials(SceneTissue& tissue, const SourceMap& where) {
  complete_material(where, "tissue.material", tissue.material);
  for (std::size_t k = 0; k < tissue.region_materials.size(); ++k)
    complete_material(where, item_path("tissue.region_material", k) + ".material",
                      tissue.region_materials[k].material);
}

void check_regions(const Scene& scene, const SourceMap& where) {
  for (std::size_t k = 0; k < scene.regions.size(); ++k)
    for (int j = 0; j < 3; ++j)
      if (const SceneRegion& region = scene.regions[k]; region.low[j] > region.high[j])
        where.fail(item_path("region", k), "low is above high along " + std::string(1, "xyz"[j]) +
                                               ", so that the box holds nothing: exchange them");
}

// Names become columns of tables and words of messages.
void check_names(const Scene& scene, const SourceMap& where) {
  const auto check = [&](const std::string& name, const std::string& key) {
    if (std::any_of(name.begin(), name.end(),
                    [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; }))
      where.fail(key, "a name must not have line breaks, tabs or other control characters");
  };
  for (std::size_t k = 0; k < scene.regions.size(); ++k)
    check(scene.regions[k].name, item_path("region", k) + ".name");
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    check(scene.instruments[k].name, item_path("instrument", k) + ".name");
  for (std::size_t k = 0; k < scene.markers.size(); ++k)
    check(scene.markers[k].name, item_path("marker", k) + ".name");
}

void check_supports(const Scene& scene, const SourceMap& where) {
  for (std::size_t k = 0; k < scene.supports.size(); ++k) {
    const SceneSupport& support = scene.supports[k];
    const std::set<char> letters(support.fix.begin(), support.fix.end());
    if (support.fix.empty() || letters.size() != support.fix.size() ||
        support.fix.find_first_not_of("xyz") != std::string::npos)
      where.fail(item_path("support", k) + ".fix",
                 "found \"" + support.fix + "\", allowed: some of \"x\", \"y\", \"z\", each once");
    if (!support.path.empty() && letters.size() != 3)
      where.fail(item_path("support", k) + ".path", "a moving support needs fix = \"xyz\"");
    if (!support.path.empty() && support.path.front().displacement != Vec3::Zero() &&
        scene.start.state != StartState::equilibrium)
      where.fail(item_path("support", k) + "." + item_path("path", 0) + ".displacement",
                 "a support begins where the body is, and this one would jump: the first "
                 "displacement must be 0, a later one moves it");
    for (std::size_t j = 1; j < support.path.size(); ++j)
      if (!(support.path[j - 1].time < support.path[j].time))
        where.fail(item_path("support", k) + "." + item_path("path", j),
                   "the times of a path must ascend");
  }
}

void check_loads(const Scene& scene, const SourceMap& where) {
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    const SceneLoad& load = scene.loads[k];
    if (load.force == Vec3::Zero() && load.pressure == 0)
      where.fail(item_path("load", k), "a load needs a force or a pressure");
    for (std::size_t j = 1; j < load.path.size(); ++j)
      if (!(load.path[j - 1].time < load.path[j].time))
        where.fail(item_path("load", k) + "." + item_path("path", j),
                   "the times of a path must ascend");
  }
}

void check_markers(const Scene& scene, const SourceMap& where) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < scene.markers.size(); ++k)
    if (!names.insert(scene.markers[k].name).second)
      where.fail(
          item_path("marker", k) + ".name",
          "two markers are called \"" + scene.markers[k].name + "\": give each its own name");
}

void check_key(const InstrumentKey& key, const std::string& name, const SourceMap& where) {
  if (key.direction.norm() < 1e-9)
    where.fail(name + ".direction", "the direction must not be zero");
  const Vec3 across = key.direction.cross(key.forward);
  if (across.norm() < 1e-6 * key.direction.norm() * std::max(1e-9, key.forward.norm()))
    where.fail(name, "forward must not be parallel to direction: give forward = [x, y, z]");
}

void check_instruments(Scene& scene, const SourceMap& where) {
  const char* kinds[] = {"probe", "grasper", "scalpel", "scissors"};
  std::set<std::string> names;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    SceneInstrument& instrument = scene.instruments[k];
    const std::string path = item_path("instrument", k);
    if (instrument.name.empty()) instrument.name = kinds[static_cast<int>(instrument.kind)];
    if (!names.insert(instrument.name).second)
      where.fail(path, "two instruments are called \"" + instrument.name + "\": give each a name");
    if (instrument.path.empty()) where.fail(path + ".path", "a path needs at least one key");
    for (std::size_t j = 0; j < instrument.path.size(); ++j) {
      check_key(instrument.path[j], path + "." + item_path("path", j), where);
      if (j > 0 && !(instrument.path[j - 1].time < instrument.path[j].time))
        where.fail(path + "." + item_path("path", j), "the times of a path must ascend");
      const bool has_jaws =
          instrument.kind == InstrumentKind::grasper || instrument.kind == InstrumentKind::scissors;
      if (instrument.path[j].action != GraspAction::none && !has_jaws)
        where.fail(path + "." + item_path("path", j) + ".action",
                   "only graspers and scissors open and close");
    }
  }
}

bool stays_inside(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.is_absolute() || !path.has_filename() || path.filename() == ".") return false;
  return std::none_of(path.begin(), path.end(), [](const auto& part) { return part == ".."; });
}

std::string plain_file(const SceneOutput& output) {
  return std::filesystem::path(output.file).lexically_normal().string();
}

// Only frames are a folder, in which others may lie.
void check_no_output_lies_in_a_file(const Scene& scene, const SourceMap& where) {
  std::vector<std::string> files = {"summary.json", "scene.toml", "checkpoint.bin"};
  for (const SceneOutput& output : scene.outputs)
    if (output.kind != OutputKind::frames) files.push_back(plain_file(output));
  for (std::size_t k = 0; k < scene.outputs.size(); ++k)
    for (const std::string& file : files)
      if (plain_file(scene.outputs[k]).starts_with(file + "/"))
        where.fail(item_path("output", k) + ".file",
                   "\"" + scene.outputs[k].file + "\" lies in \"" + file + "\", which is a file");
}

// "000042.png"
bool is_name_of_frame(const std::string& name) {
  return name.size() > 4 && name.ends_with(".png") &&
         name.find_first_not_of("0123456789") == name.size() - 4;
}

// Others may lie among the pictures of a frames output, but not under the name of one.
void check_no_output_is_a_frame(const Scene& scene, const SourceMap& where) {
  std::set<std::string> folders;
  for (const SceneOutput& output : scene.outputs)
    if (output.kind == OutputKind::frames) folders.insert(plain_file(output));
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const std::filesystem::path file(plain_file(scene.outputs[k]));
    if (folders.contains(file.parent_path().string()) && is_name_of_frame(file.filename().string()))
      where.fail(item_path("output", k) + ".file",
                 "\"" + scene.outputs[k].file + "\" has the name of a picture of the frames in \"" +
                     file.parent_path().string() + "\", which would be written over it");
  }
}

void check_outputs(const Scene& scene, const SourceMap& where) {
  std::set<std::string> files;
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const SceneOutput& output = scene.outputs[k];
    const std::string path = item_path("output", k);
    if (!stays_inside(output.file))
      where.fail(path + ".file",
                 "\"" + output.file + "\" must be a relative path inside the output folder");
    const std::string plain = plain_file(output);
    if (plain == "summary.json" || plain == "scene.toml" || plain == ".trocar-lock" ||
        plain.starts_with("checkpoint.bin"))
      where.fail(path + ".file", "\"" + plain + "\" is written by every run: choose another name");
    if (!files.insert(plain).second)
      where.fail(path + ".file", "two outputs write \"" + output.file + "\"");
    const bool is_picture = output.kind == OutputKind::video || output.kind == OutputKind::frames ||
                            output.kind == OutputKind::contact_sheet;
    const bool is_known =
        std::any_of(scene.cameras.begin(), scene.cameras.end(),
                    [&](const SceneCamera& c) { return c.name == output.camera; });
    const std::string ending = std::filesystem::path(plain).extension().string();
    if (output.kind == OutputKind::contact_sheet && !ending.empty() && ending != ".png")
      where.fail(path + ".file", "a contact sheet is a PNG picture, and \"" + output.file +
                                     "\" has another ending: end it in .png");
    if (is_picture && scene.cameras.empty()) where.fail(path, "a picture needs a [[camera]]");
    if (is_picture && !output.camera.empty() && !is_known)
      where.fail(path + ".camera", "there is no camera \"" + output.camera + "\"");
  }
}

void check_cameras(const Scene& scene, const SourceMap& where) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < scene.cameras.size(); ++k) {
    const SceneCamera& camera = scene.cameras[k];
    if (!names.insert(camera.name).second)
      where.fail(item_path("camera", k),
                 "two cameras are called \"" + camera.name + "\": give each a name");
    const Vec3 view = camera.target - camera.eye;
    if (view.norm() < 1e-9 ||
        view.cross(camera.up).norm() < 1e-6 * view.norm() * std::max(1e-9, camera.up.norm()))
      where.fail(item_path("camera", k),
                 "eye and target must differ and up must not point along the view");
  }
}

// Elements in single precision leave some 1e-6 of the supports' forces out of balance.
void check_start(const Scene& scene, const SourceMap& where) {
  constexpr double least_in_single = 3e-5;
  if (scene.start.state == StartState::equilibrium &&
      scene.solver.precision == Precision::in_single && scene.start.tolerance < least_in_single)
    where.fail("start.tolerance",
               "with solver.precision = \"single\" the tolerance must be 3e-5 or more");
}

void check_contact(const Scene& scene, const SourceMap& where) {
  if (scene.contact.has_tissue && scene.solver.sleep != 0)
    where.fail("contact.tissue", "what sleeps cannot be touched by tissue: leave out solver.sleep");
}

void check_time(const Scene& scene, const SourceMap& where) {
  if (scene.time.duration * scene.time.frame_rate < 1)
    where.fail("time.duration", "the duration is shorter than one frame");
  if (scene.time.duration * scene.time.frame_rate > 1e7)
    where.fail("time.duration",
               "more than 10 million frames: shorten the duration or lower the frame rate");
}

}  // namespace

bool has_metrics(const Scene& scene) {
  return std::any_of(scene.outputs.begin(), scene.outputs.end(),
                     [](const SceneOutput& output) { return output.kind == OutputKind::metrics; });
}

LoadedScene load_scene(const std::string& file, const std::vector<std::string>& overrides) {
  Located<Scene> located = read_options(scene_options(), file, overrides);
  const Scene& scene = located.value;
  check_time(scene, located.where);
  check_tissue(scene, located.where);
  check_shortcuts(scene, located.where);
  complete_materials(located.value.tissue, located.where);
  check_names(scene, located.where);
  check_regions(scene, located.where);
  check_supports(scene, located.where);
  check_loads(scene, located.where);
  check_markers(scene, located.where);
  check_instruments(located.value, located.where);
  check_cameras(scene, located.where);
  check_outputs(scene, located.where);
  check_no_output_lies_in_a_file(scene, located.where);
  check_no_output_is_a_frame(scene, located.where);
  check_start(scene, located.where);
  check_contact(scene, located.where);
  std::string folder = std::filesystem::path(file).parent_path().string();
  if (!folder.empty()) folder += "/";
  return {.scene = std::move(located.value),
          .where = std::move(located.where),
          .folder = std::move(folder)};
}

}  // namespace trocar
