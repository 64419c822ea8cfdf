#include "engine/output_check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/options.h"
#include "engine/run_files.h"
#include "engine/tissue.h"

namespace trocar {

namespace {

namespace fs = std::filesystem;

bool are_one_file(const fs::path& a, const fs::path& b) {
  std::error_code trouble;
  return fs::equivalent(a, b, trouble) && !trouble;
}

std::vector<std::string> meshes(const LoadedScene& loaded) {
  std::vector<std::string> files;
  const auto add = [&](const std::string& mesh) {
    if (!mesh.empty()) files.push_back(scene_path(loaded, mesh));
  };
  add(loaded.scene.tissue.mesh);
  for (const SceneInstrument& instrument : loaded.scene.instruments) add(instrument.mesh);
  return files;
}

void refuse(const std::string& input, const std::string& folder) {
  throw InputError("the run would write over " + input +
                   ", which it reads: choose another folder than \"" + folder +
                   "\" with -o, or another name for the output");
}

// Of what should be a whole number of frames.
void warn_of_rounding(const std::string& key, double seconds, double frame_rate) {
  const double n = std::max(1.0, std::round(seconds * frame_rate));
  if (std::abs(seconds * frame_rate - n) < 1e-6 * n) return;
  const double taken = n / frame_rate;
  const bool is_clear = short_text(seconds) != short_text(taken);
  const auto text = [&](double value) { return is_clear ? short_text(value) : number_text(value); };
  log_warning(key + " = " + text(seconds) + " s is no whole number of frames of " +
              shortest_text(frame_rate) + " Hz: it is taken as " +
              std::to_string(static_cast<std::int64_t>(n)) + " of them, " + text(taken) + " s");
}

}  // namespace

std::string echo_in(const std::string& folder, const LoadedScene& loaded,
                    const std::string& scene_file) {
  if (are_one_file(scene_file, folder + "/" + scene_name)) return "";
  Scene scene = loaded.scene;
  const auto take_along = [&](std::string& mesh) {
    if (!mesh.empty() && !mesh.starts_with('/'))
      mesh = fs::proximate(scene_path(loaded, mesh), fs::absolute(folder)).string();
  };
  take_along(scene.tissue.mesh);
  for (SceneInstrument& instrument : scene.instruments) take_along(instrument.mesh);
  return echo_options(scene_options(), &scene);
}

void check_inputs_stay(const LoadedScene& loaded, const std::string& scene_file,
                       const std::string& folder) {
  std::vector<std::string> written = {summary_name, checkpoint_name};
  for (const SceneOutput& output : loaded.scene.outputs) written.push_back(output.file);
  for (const std::string& name : written) {
    const std::string file = folder + "/" + name;
    if (are_one_file(file, scene_file)) refuse(scene_file, folder);
    for (const std::string& mesh : meshes(loaded))
      if (are_one_file(file, mesh)) refuse(mesh, folder);
  }
}

void warn_of_outputs(const Scene& scene, const std::string& folder) {
  const SceneTime& time = scene.time;
  warn_of_rounding("time.duration", time.duration, time.frame_rate);
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const SceneOutput& output = scene.outputs[k];
    const std::string key = item_path("output", k) + ".every";
    if (output.every > time.duration)
      log_warning(key + " = " + short_text(output.every) +
                  " s is longer than the run: nothing is written into \"" + output.file + "\"");
    else if (output.every > 0)
      warn_of_rounding(key, output.every, time.frame_rate);
  }
  if (fs::exists(folder + "/" + summary_name))
    log_warning(
        "\"" + folder +
        "\" has files of an earlier run: those that this one does not write stay beside its own");
}

}  // namespace trocar
