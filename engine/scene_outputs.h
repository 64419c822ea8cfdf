// Cameras and outputs of a scene: what is wrong with them.
#pragma once

#include "engine/scene.h"

namespace trocar {

// "no camera "othr"; the nearest is "other"; there are "other"".
std::string no_camera_text(const Scene& scene, const std::string& name);

// Each by itself.
void check_views(const Scene& scene, OptionErrors& errors);
void check_output_files(const Scene& scene, OptionErrors& errors);

// With each other.
void check_outputs_together(const Scene& scene, OptionErrors& errors);

}  // namespace trocar
