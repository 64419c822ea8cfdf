// Whether a scene fits the mesh of its body.
#pragma once

#include "engine/scene.h"
#include "mesh/mesh.h"

namespace trocar {

// Names of regions, markers, blades, and what a plane body can't do. The mesh is in its place and
// has all node sets.
void check_fit(const Scene& scene, const Mesh& mesh, OptionErrors& errors);

}  // namespace trocar
