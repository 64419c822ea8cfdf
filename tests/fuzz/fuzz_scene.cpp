// Scene files and --set: all that is told before a body is built.
#include <sstream>

#include "base/check.h"
#include "engine/scene.h"
#include "engine/tool_path.h"
#include "fuzz_targets.h"
#include "test_files.h"

namespace trocar {

namespace {

// What was read is written as it is read again.
void look_at_echo(const Scene& scene) {
  static const Options<Scene> options = scene_options();
  const std::string echo = echo_options(options, &scene);
  Scene back;
  SourceMap where;
  CHECK(is_taken([&] { read_options_text(options, echo, "the echo", {}, &back, where); }));
  CHECK(echo_options(options, &back) == echo);
}

void look_at_paths(const Scene& scene) {
  for (const SceneInstrument& instrument : scene.instruments) {
    const ToolPath path(instrument.path);
    const double first = instrument.path.front().time, last = instrument.path.back().time;
    for (const double share : {-1.0, 0.0, 0.3, 0.5, 1.0, 2.0})
      CHECK(path.at(first + share * (last - first)).translation.allFinite());
    path.largest_bulge();
  }
  for (const SceneSupport& support : scene.supports)
    CHECK(DisplacementPath(support.path).at(scene.time.duration / 2).allFinite());
}

// One list of each kind and one value of each key.
std::string scene_of_all_keys() {
  Scene scene;
  scene.tissue.shape = SceneShape{};
  scene.tissue.region_materials = {{.region = "lump", .material = {}, .look = SceneRegionLook{}}};
  scene.regions = {{.name = "lump", .high = Vec3(1, 1, 1)}};
  scene.supports = {{.region = "lump", .fix = "xyz", .path = {{}, {.time = 1}}}};
  scene.loads = {{.region = "lump", .force = Vec3(1, 0, 0), .path = {{}, {.time = 1}}}};
  scene.instruments = {{.name = "a", .path = {{}, {.time = 1, .position = Vec3(0, 0, 1)}}},
                       {.kind = InstrumentKind::scalpel, .name = "b", .path = {{}}}};
  scene.markers = {{.name = "m"}};
  scene.cameras = {{}};
  scene.outputs = {{.file = "m.csv"}};
  return echo_options(scene_options(), &scene);
}

constexpr const char* plain_scene =
    "[time]\nduration = \"1 s\"\n[tissue.shape]\nkind = \"box\"\n[[instrument]]\nkind = \"probe\"\n"
    "path = [ { time = 0, position = [0, 0, 1] } ]\n";

}  // namespace

bool read_scene_bytes(std::string_view bytes) {
  const std::string file = hostile_file("scene.toml", bytes);
  return is_taken([&] {
    const LoadedScene loaded = load_scene(file, {});
    look_at_echo(loaded.scene);
    look_at_paths(loaded.scene);
  });
}

// One override a line.
bool read_override_lines(std::string_view bytes) {
  static const Options<Scene> options = scene_options();
  std::vector<std::string> overrides;
  std::istringstream lines{std::string(bytes)};
  for (std::string line; std::getline(lines, line);) overrides.push_back(line);
  return is_taken([&] {
    Scene scene;
    SourceMap where;
    read_options_text(options, plain_scene, "scene.toml", overrides, &scene, where);
    look_at_echo(scene);
  });
}

std::vector<FuzzSeed> scene_seeds() {
  std::vector<FuzzSeed> seeds = {{"plain.toml", plain_scene},
                                 {"all_keys.toml", scene_of_all_keys()}};
  const std::string configs = std::string(TROCAR_SOURCE_DIR) + "/configs";
  for (const auto& entry : std::filesystem::directory_iterator(configs)) {
    if (entry.path().extension() != ".toml") continue;
    const std::string text = read_text(entry.path());
    // Not those that name files beside them.
    if (text.find("mesh = ") == std::string::npos) seeds.push_back({entry.path().filename(), text});
  }
  return seeds;
}

std::vector<FuzzSeed> override_seeds() {
  return {{"values",
           "tissue.material.density=1000 kg/m^3\ninstrument[0].radius='3 mm'\n"
           "time.pace=real-time\nsolver.gravity=[0, 0, '-9.81 m/s^2']\n"},
          {"tables",
           "instrument=[{kind='scalpel',path=[{time=0,position=[0,0,1]}]}]\n"
           "tissue.look={wetness=0.5}\ninstrument[0].path[0].time='10 ms'\n"}};
}

}  // namespace trocar
