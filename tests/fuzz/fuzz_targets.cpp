#include "fuzz_targets.h"

#include "base/error.h"
#include "test_files.h"

namespace trocar {

std::vector<FuzzTarget> fuzz_targets() {
  return {{"scene", read_scene_bytes, scene_seeds},
          {"override", read_override_lines, override_seeds},
          {"gmsh", read_gmsh_bytes, gmsh_seeds},
          {"vtk", read_vtk_bytes, vtk_seeds},
          {"vtu", read_vtu_bytes, vtu_seeds},
          {"stl", read_stl_bytes, stl_seeds},
          {"obj", read_obj_bytes, obj_seeds},
          {"recording", read_recording_bytes, recording_seeds, change_recording},
          {"checkpoint", read_checkpoint_bytes, checkpoint_seeds, change_checkpoint}};
}

bool is_taken(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string hostile_file(const std::string& name, std::string_view bytes) {
  static const TestFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    std::filesystem::remove_all(entry.path());
  return folder.file(name, bytes);
}

}  // namespace trocar
