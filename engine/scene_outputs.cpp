#include "engine/scene_outputs.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/quoted.h"
#include "engine/run_files.h"
#include "render/image_file.h"

namespace trocar {

namespace {

bool stays_inside(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.is_absolute() || !path.has_filename() || path.filename() == ".") return false;
  return std::none_of(path.begin(), path.end(), [](const auto& part) { return part == ".."; });
}

std::string plain_file(const SceneOutput& output) {
  return std::filesystem::path(output.file).lexically_normal().string();
}

// Only frames are a folder, in which others may lie.
void check_no_output_lies_in_a_file(const Scene& scene, OptionErrors& errors) {
  std::vector<std::string> files(run_files.begin(), run_files.end());
  for (const SceneOutput& output : scene.outputs)
    if (output.kind != OutputKind::frames) files.push_back(plain_file(output));
  for (std::size_t k = 0; k < scene.outputs.size(); ++k)
    for (const std::string& file : files)
      if (plain_file(scene.outputs[k]).starts_with(file + "/"))
        errors.add(item_path("output", k) + ".file",
                   "\"" + scene.outputs[k].file + "\" lies in \"" + file + "\", which is a file");
}

// "000042.png"
bool is_name_of_frame(const std::string& name) {
  return name.size() > 4 && name.ends_with(".png") &&
         name.find_first_not_of("0123456789") == name.size() - 4;
}

// Others may lie among the pictures of a frames output, but not under the name of one.
void check_no_output_is_a_frame(const Scene& scene, OptionErrors& errors) {
  std::set<std::string> folders;
  for (const SceneOutput& output : scene.outputs)
    if (output.kind == OutputKind::frames) folders.insert(plain_file(output));
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const std::filesystem::path file(plain_file(scene.outputs[k]));
    if (folders.contains(file.parent_path().string()) && is_name_of_frame(file.filename().string()))
      errors.add(item_path("output", k) + ".file",
                 "\"" + scene.outputs[k].file + "\" has the name of a picture of the frames in \"" +
                     file.parent_path().string() + "\", which would be written over it");
  }
}

void check_files_differ(const Scene& scene, OptionErrors& errors) {
  std::set<std::string> files;
  for (std::size_t k = 0; k < scene.outputs.size(); ++k)
    if (!files.insert(plain_file(scene.outputs[k])).second)
      errors.add(item_path("output", k) + ".file",
                 "two outputs write \"" + scene.outputs[k].file + "\"");
}

void check_cameras_of_outputs(const Scene& scene, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const SceneOutput& output = scene.outputs[k];
    if (!is_picture(output.kind)) continue;
    // Once, for all of them.
    if (scene.cameras.empty())
      return errors.add(item_path("output", k) + ".kind", "a picture needs a [[camera]]");
    if (!find_camera(scene, output.camera))
      errors.add(item_path("output", k) + ".camera",
                 "there is " + no_camera_text(scene, output.camera));
  }
}

}  // namespace

std::string no_camera_text(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const SceneCamera& camera : scene.cameras) names.push_back(camera.name);
  return "no camera \"" + name + "\"" + names_hint(name, names);
}

void check_views(const Scene& scene, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.cameras.size(); ++k) {
    const SceneCamera& camera = scene.cameras[k];
    const std::string path = item_path("camera", k);
    const Vec3 view = camera.target - camera.eye;
    const double across = view.cross(camera.up).norm();
    if (view.norm() < 1e-9)
      errors.add(path + ".target", "eye and target must differ");
    else if (across < 1e-6 * view.norm() * std::max(1e-9, camera.up.norm()))
      errors.add_at_first({path + ".up", path + ".target"},
                          "up must not point along the view, from eye to target: give up = [x, y, "
                          "z] across it");
  }
}

void check_output_files(const Scene& scene, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const SceneOutput& output = scene.outputs[k];
    const std::string key = item_path("output", k) + ".file", plain = plain_file(output);
    const std::string ending = std::filesystem::path(plain).extension().string();
    if (!stays_inside(output.file))
      errors.add(key, "\"" + output.file + "\" must be a relative path inside the output folder");
    if (std::ranges::find(run_files, plain) != run_files.end() ||
        plain.starts_with(checkpoint_name))
      errors.add(key, "\"" + plain + "\" is written by every run: choose another name");
    const std::string fault = output.kind == OutputKind::video ? film_name_fault(plain) : "";
    if (!fault.empty()) errors.add(key, fault);
    if (output.kind == OutputKind::contact_sheet && !ending.empty() && ending != ".png")
      errors.add(key, "a contact sheet is a PNG picture, and \"" + output.file +
                          "\" has another ending: end it in .png");
  }
}

void check_outputs_together(const Scene& scene, OptionErrors& errors) {
  check_files_differ(scene, errors);
  check_no_output_lies_in_a_file(scene, errors);
  check_no_output_is_a_frame(scene, errors);
  check_cameras_of_outputs(scene, errors);
}

}  // namespace trocar
