// Small scenes as text for the tests of reading and checking.
#pragma once

#include <string>
#include <vector>

#include "engine/scene.h"
#include "error_of.h"
#include "test_files.h"

namespace trocar {

// The least that a scene needs; `more` follows.
std::string scene_text(const std::string& more = "");

inline const std::string camera_text = "[[camera]]\neye = [0, -1, 0]\ntarget = [0, 0, 0]\n";

// An instrument of a kind with a path of one key; `key` replaces what stands in the key's braces.
std::string instrument_text(const std::string& kind,
                            const std::string& keys = "{ time = 0, position = [0, 0, 1] }");

Scene load_scene_text(const std::string& text, const std::vector<std::string>& overrides = {});

// The sentence that refuses the scene, "" if it is taken.
std::string scene_error(const std::string& text);

}  // namespace trocar
