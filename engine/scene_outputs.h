// Cameras and outputs of a scene: what is wrong with them.
#pragma once

#include "engine/scene.h"

namespace trocar {

// Each by itself.
void check_views(const Scene& scene, OptionErrors& errors);
void check_output_files(const Scene& scene, OptionErrors& errors);

// With each other.
void check_cameras(const Scene& scene, OptionErrors& errors);
void check_outputs_together(const Scene& scene, OptionErrors& errors);

}  // namespace trocar
