#include "engine_scene.h"

namespace trocar {

std::string scene_text(const std::string& more) {
  return "[time]\nduration = \"1 s\"\n[tissue.shape]\nkind = \"box\"\n" + more;
}

std::string instrument_text(const std::string& kind, const std::string& keys) {
  return "[[instrument]]\nkind = \"" + kind + "\"\npath = [ " + keys + " ]\n";
}

Scene load_scene_text(const std::string& text, const std::vector<std::string>& overrides) {
  const TestFolder folder;
  return load_scene(write_text(folder.file("s.toml"), text), overrides).scene;
}

std::string scene_error(const std::string& text) {
  return error_of([&] { load_scene_text(text); });
}

}  // namespace trocar
