// What one key alone can't tell: names that refer to each other, times that ascend, files that stay
// where they belong.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/number_text.h"
#include "base/quoted.h"
#include "base/whole_file.h"
#include "engine/scene.h"
#include "engine/scene_outputs.h"
#include "engine/support_forces.h"
#include "engine/tissue.h"

namespace trocar {

namespace {

void check_file(const std::string& key, const std::string& file, const LoadedScene& loaded,
                OptionErrors& errors) {
  if (file.empty()) return;
  const std::string fault = fault_of_file(scene_path(loaded, file));
  if (!fault.empty()) errors.add(key, fault);
}

void check_shape(const SceneShape& shape, OptionErrors& errors) {
  const bool is_box = shape.kind == ShapeKind::box;
  if (is_box && !(shape.low.array() < shape.high.array()).all())
    errors.add_at_first({"tissue.shape.high", "tissue.shape.low"},
                        "each component of low must be below that of high");
  const bool is_round = shape.kind == ShapeKind::ball || shape.kind == ShapeKind::cylinder;
  if (is_round && shape.elements == BoxElements::tet4_five)
    errors.add("tissue.shape.elements",
               "balls and cylinders can't be of tet4-five, some of which would be flat: take "
               "\"tet4-kuhn\" or \"hex8\"");
  const bool is_rectangle = shape.kind == ShapeKind::rectangle;
  if (is_rectangle && !(shape.high.x() > 0 && shape.high.y() > 0))
    errors.add("tissue.shape.high", "a rectangle reaches from 0 to here: x and y must be > 0");
  if (shape.kind == ShapeKind::triangular_rectangle && !(shape.high.x() > 0))
    errors.add("tissue.shape.high",
               "a triangular-rectangle reaches from 0 to this x, which must be > 0");
}

void check_tissue(const LoadedScene& loaded, OptionErrors& errors) {
  const SceneTissue& tissue = loaded.scene.tissue;
  if (tissue.mesh.empty() == !tissue.shape)
    errors.add_at_first(
        {"tissue.mesh", "tissue"},
        "give either a mesh file (mesh = \"…\") or a generated body ([tissue.shape]), "
        "exactly one of them");
  else
    check_file("tissue.mesh", tissue.mesh, loaded, errors);
  if (tissue.shape) check_shape(*tissue.shape, errors);
}

// Where tissue is viscoelastic, and what leaves the viscosity out; "" if nowhere.
std::string viscosity_text(const SceneTissue& tissue) {
  std::string places, settings;
  const auto look_at = [&](const SceneMaterial& m, const std::string& who,
                           const std::string& path) {
    if (m.prony.empty()) return;
    places += (places.empty() ? "the Prony branches of " : " and of ") + who;
    if (!m.tissue.empty()) places += " (tissue " + in_quotes(m.tissue) + ")";
    settings += (settings.empty() ? "--set '" : " --set '") + path + ".prony=[]'";
  };
  look_at(tissue.material, "the body", "tissue.material");
  for (std::size_t k = 0; k < tissue.region_materials.size(); ++k) {
    const SceneRegionMaterial& other = tissue.region_materials[k];
    look_at(other.material, "region " + in_quotes(other.region),
            item_path("tissue.region_material", k) + ".material");
  }
  return places.empty() ? "" : places + ", by prony = [] there (" + settings + ")";
}

// A history of strains can't be left out, nor computed several times a step; the same with volume
// changes averaged over elements of which only some are computed again.
void check_shortcuts(const Scene& scene, OptionErrors& errors) {
  const SceneSolver& solver = scene.solver;
  const std::string viscosity = viscosity_text(scene.tissue);
  if (solver.sleep > 0 && !viscosity.empty())
    errors.add("solver.sleep", "viscoelastic tissue can't sleep: leave out sleep, or " + viscosity);
  if (!solver.is_multirate) return;
  if (!viscosity.empty() || solver.tetrahedron == Formulation::tet4_nodal_pressure ||
      solver.mass_scaling_step > 0 || solver.stable_step != StableStep::frequency)
    errors.add("solver.multirate",
               "it needs stable_step = \"frequency\" and none of prony, tetrahedron = "
               "\"nodal-pressure\", mass_scaling_step" +
                   (viscosity.empty() ? "" : ": leave out multirate, or " + viscosity));
}

void complete_look(const SceneLook& of_tissue, SceneRegionLook& look) {
  if (!look.colour.allFinite()) look.colour = of_tissue.colour;
  if (!look.cut_colour.allFinite()) look.cut_colour = of_tissue.cut_colour;
}

void complete_materials(SceneTissue& tissue, OptionErrors& errors) {
  complete_material("tissue.material", tissue.material, errors);
  for (std::size_t k = 0; k < tissue.region_materials.size(); ++k) {
    SceneRegionMaterial& other = tissue.region_materials[k];
    complete_material(item_path("tissue.region_material", k) + ".material", other.material, errors);
    if (other.look) complete_look(tissue.look, *other.look);
  }
}

void check_regions(const Scene& scene, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.regions.size(); ++k)
    for (int j = 0; j < 3; ++j)
      if (const SceneRegion& region = scene.regions[k]; region.low[j] > region.high[j])
        errors.add(item_path("region", k) + ".low",
                   std::string("low is above high along ") + "xyz"[j] +
                       ", so that the box holds nothing: exchange them");
}

// Names become columns of tables and words of messages.
void check_names(const Scene& scene, OptionErrors& errors) {
  const auto check = [&](const std::string& name, const std::string& key) {
    if (std::any_of(name.begin(), name.end(),
                    [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; }))
      errors.add(key, "a name must not have line breaks, tabs or other control characters");
  };
  check(scene.name, "name");
  for (std::size_t k = 0; k < scene.regions.size(); ++k)
    check(scene.regions[k].name, item_path("region", k) + ".name");
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    check(scene.instruments[k].name, item_path("instrument", k) + ".name");
  for (std::size_t k = 0; k < scene.markers.size(); ++k)
    check(scene.markers[k].name, item_path("marker", k) + ".name");
}

// Once for a path: what else does not ascend may follow from it.
template <class Keys>
void check_times(const Keys& keys, const std::string& owner, OptionErrors& errors) {
  const auto later = std::ranges::adjacent_find(
      keys, [](const auto& a, const auto& b) { return !(a.time < b.time); });
  if (later == keys.end()) return;
  const auto j = static_cast<std::size_t>(later - keys.begin()) + 1;
  errors.add(owner + "." + item_path("path", j) + ".time",
             "the times of a path must ascend, and " + short_text(keys[j].time) +
                 " s does not come after " + short_text(keys[j - 1].time) + " s");
}

void check_support(const SceneSupport& support, const std::string& path, OptionErrors& errors) {
  const std::set<char> letters(support.fix.begin(), support.fix.end());
  if (support.fix.empty() || letters.size() != support.fix.size() ||
      support.fix.find_first_not_of("xyz") != std::string::npos)
    errors.add(path + ".fix",
               "found \"" + support.fix + "\", allowed: some of \"x\", \"y\", \"z\", each once");
  else if (!support.path.empty() && letters.size() != 3)
    errors.add(path + ".fix", "a moving support needs fix = \"xyz\", and this one has a path");
  check_times(support.path, path, errors);
}

void check_supports(const Scene& scene, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.supports.size(); ++k)
    check_support(scene.supports[k], item_path("support", k), errors);
}

void check_loads(const Scene& scene, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    const SceneLoad& load = scene.loads[k];
    const std::string path = item_path("load", k);
    if (load.force == Vec3::Zero() && load.pressure == 0)
      errors.add_at_first({path + ".force", path + ".pressure", path},
                          "a load needs a force or a pressure that is not 0");
    check_times(load.path, path, errors);
  }
}

template <class Items>
void check_names_differ(const Items& items, const std::string& list, OptionErrors& errors) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < items.size(); ++k)
    if (!names.insert(items[k].name).second)
      errors.add(item_path(list, k) + ".name",
                 "two " + list + "s are called \"" + items[k].name + "\": give each its own name");
}

void check_key(const InstrumentKey& key, bool has_jaws, const std::string& path,
               OptionErrors& errors) {
  const Vec3 across = key.direction.cross(key.forward);
  if (key.direction.norm() < 1e-9)
    errors.add(path + ".direction", "the direction must not be zero");
  else if (across.norm() < 1e-6 * key.direction.norm() * std::max(1e-9, key.forward.norm()))
    errors.add_at_first({path + ".forward", path + ".direction"},
                        "forward must not be parallel to direction: give forward = [x, y, z]");
  if (key.action != GraspAction::none && !has_jaws)
    errors.add(path + ".action", "only graspers and scissors open and close");
}

void check_instruments(const LoadedScene& loaded, OptionErrors& errors) {
  for (std::size_t k = 0; k < loaded.scene.instruments.size(); ++k) {
    const SceneInstrument& instrument = loaded.scene.instruments[k];
    const std::string path = item_path("instrument", k);
    const bool has_jaws =
        instrument.kind == InstrumentKind::grasper || instrument.kind == InstrumentKind::scissors;
    if (instrument.path.empty()) errors.add(path + ".path", "a path needs at least one key");
    for (std::size_t j = 0; j < instrument.path.size(); ++j)
      check_key(instrument.path[j], has_jaws, path + "." + item_path("path", j), errors);
    check_times(instrument.path, path, errors);
    check_file(path + ".mesh", instrument.mesh, loaded, errors);
  }
}

bool is_column_of_other(const Scene& scene, const std::string& name) {
  const auto is_support = [&](const std::string& of) { return name == "support_" + of; };
  const auto is_marker = [&](const SceneMarker& of) { return name == "marker_" + of.name; };
  return std::ranges::any_of(support_names(scene.supports), is_support) ||
         std::ranges::any_of(scene.markers, is_marker);
}

void name_instruments(Scene& scene, OptionErrors& errors) {
  for (SceneInstrument& instrument : scene.instruments)
    if (instrument.name.empty())
      instrument.name = instrument_kinds[static_cast<std::size_t>(instrument.kind)].first;
  check_names_differ(scene.instruments, "instrument", errors);
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (const std::string& name = scene.instruments[k].name; is_column_of_other(scene, name))
      errors.add(item_path("instrument", k) + ".name",
                 "\"" + name +
                     "\" is what the metrics call a marker or a support: give the instrument "
                     "another name");
}

// Elements in single precision leave some 1e-6 of the supports' forces out of balance.
void check_start(const Scene& scene, OptionErrors& errors) {
  constexpr double least_in_single = 3e-5;
  const bool is_sought = scene.start.state == StartState::equilibrium;
  if (is_sought && scene.solver.precision == Precision::in_single &&
      scene.start.tolerance < least_in_single)
    errors.add("start.tolerance",
               "with solver.precision = \"single\" the tolerance must be 3e-5 or more");
  for (std::size_t k = 0; k < scene.supports.size(); ++k)
    if (const auto& path = scene.supports[k].path;
        !is_sought && !path.empty() && path.front().displacement != Vec3::Zero())
      errors.add(item_path("support", k) + "." + item_path("path", 0) + ".displacement",
                 "a support begins where the body is, and this one would jump: the first "
                 "displacement must be 0, a later one moves it");
}

void check_contact(const Scene& scene, OptionErrors& errors) {
  if (scene.contact.has_tissue && scene.solver.sleep != 0)
    errors.add("contact.tissue", "what sleeps cannot be touched by tissue: leave out solver.sleep");
}

void check_time(const Scene& scene, OptionErrors& errors) {
  if (scene.time.duration * scene.time.frame_rate < 1)
    errors.add("time.duration", "the duration is shorter than one frame (1 / frame_rate)");
  if (scene.time.duration * scene.time.frame_rate > 1e7)
    errors.add("time.duration",
               "more than 10 million frames: shorten the duration or lower the frame rate");
}

}  // namespace

bool has_blades(const Scene& scene) {
  return std::ranges::any_of(scene.instruments,
                             [](const SceneInstrument& i) { return has_blade(i.kind); });
}

bool has_metrics(const Scene& scene) {
  return std::any_of(scene.outputs.begin(), scene.outputs.end(),
                     [](const SceneOutput& output) { return output.kind == OutputKind::metrics; });
}

double step_factor_of(const SceneSolver& solver, const Mesh& mesh) {
  if (!std::isnan(solver.step_factor)) return solver.step_factor;
  const bool is_plane_stress =
      mesh.dimension() == 2 && solver.triangle == Formulation::tri3_plane_stress;
  return is_plane_stress ? 0.7 : 0.85;
}

const SceneCamera* find_camera(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find_if(
      scene.cameras, [&](const SceneCamera& c) { return name.empty() || c.name == name; });
  return found != scene.cameras.end() ? &*found : nullptr;
}

// What each table tells by itself.
static void check_tables(LoadedScene& loaded, OptionErrors& errors) {
  const Scene& scene = loaded.scene;
  check_time(scene, errors);
  check_tissue(loaded, errors);
  complete_materials(loaded.scene.tissue, errors);
  check_names(scene, errors);
  check_regions(scene, errors);
  check_supports(scene, errors);
  check_loads(scene, errors);
  check_instruments(loaded, errors);
  check_views(scene, errors);
  check_output_files(scene, errors);
}

// What only several tables tell together.
static void check_tables_together(LoadedScene& loaded, OptionErrors& errors) {
  const Scene& scene = loaded.scene;
  check_shortcuts(scene, errors);
  check_names_differ(scene.markers, "marker", errors);
  name_instruments(loaded.scene, errors);
  check_names_differ(scene.cameras, "camera", errors);
  check_outputs_together(scene, errors);
  check_start(scene, errors);
  check_contact(scene, errors);
}

LoadedScene load_scene(const std::string& file, const std::vector<std::string>& overrides) {
  LoadedScene loaded;
  loaded.folder = std::filesystem::path(file).parent_path().string();
  if (!loaded.folder.empty()) loaded.folder += "/";
  OptionErrors errors(loaded.where);
  read_options(scene_options(), file, overrides, &loaded.scene, loaded.where, errors);
  const bool is_read = errors.is_empty();
  check_tables(loaded, errors);
  if (is_read) check_tables_together(loaded, errors);
  errors.throw_if_any();
  return loaded;
}

}  // namespace trocar
