// Real meshes, which lie beside the checkout or don't.
#pragma once

#include <filesystem>
#include <string>

namespace trocar {

// "" where the folder of real meshes is not at hand.
inline std::string real_file(const std::string& name) {
  const std::filesystem::path file =
      std::filesystem::path(TROCAR_SOURCE_DIR) / "../shared/data" / name;
  return std::filesystem::exists(file) ? file.string() : "";
}

}  // namespace trocar
