// What of a scene's outputs is wrong or surprises, before anything is written.
#pragma once

#include <string>

#include "engine/scene.h"

namespace trocar {

// The effective scene as scene.toml of this folder, from which relative mesh paths start then;
// empty where that is the scene file, which stays as its user wrote it.
std::string echo_in(const std::string& folder, const LoadedScene& loaded,
                    const std::string& scene_file);

// Throws InputError where a run of the scene in this folder would write over the scene file or over
// a mesh that it reads.
void check_inputs_stay(const LoadedScene& loaded, const std::string& scene_file,
                       const std::string& folder);

// Of intervals that are no whole number of frames or longer than the run, and of files of an
// earlier run that will lie beside this one's.
void warn_of_outputs(const Scene& scene, const std::string& folder);

}  // namespace trocar
