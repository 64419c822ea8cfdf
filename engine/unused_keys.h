// Keys of a scene that are given and have no effect on it.
#pragma once

#include <string>
#include <vector>

#include "engine/scene.h"
#include "mesh/mesh.h"

namespace trocar {

// A sentence each. Given is what differs from its default, so that the echo of a scene, which has
// every key, tells what the scene does.
std::vector<std::string> unused_keys(const Scene& scene, const Mesh& mesh);

}  // namespace trocar
