// Small scenes as text for the tests of reading and checking.
#pragma once

#include <string>
#include <vector>

#include "engine/scene.h"
#include "engine_files.h"

namespace trocar {

// The least that a scene needs; `more` follows.
inline std::string scene_text(const std::string& more = "") {
  return "[time]\nduration = \"1 s\"\n[tissue.shape]\nkind = \"box\"\n" + more;
}

inline const std::string camera_text = "[[camera]]\neye = [0, -1, 0]\ntarget = [0, 0, 0]\n";

// An instrument of a kind with a path of one key; `key` replaces what stands in the key's braces.
inline std::string instrument_text(const std::string& kind,
                                   const std::string& keys = "{ time = 0, position = [0, 0, 1] }") {
  return "[[instrument]]\nkind = \"" + kind + "\"\npath = [ " + keys + " ]\n";
}

inline Scene load_scene_text(const std::string& text,
                             const std::vector<std::string>& overrides = {}) {
  const TestFolder folder;
  return load_scene(write_text(folder.file("s.toml"), text), overrides).scene;
}

// The sentence that refuses the scene, "" if it is taken.
inline std::string scene_error(const std::string& text) {
  return input_error_of([&] { load_scene_text(text); });
}

}  // namespace trocar
