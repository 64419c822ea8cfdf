// Supports that hold the same nodes: of those at rest the first has a node's component, before all
// that move, of which the first has the node.
#pragma once

#include "engine/scene.h"
#include "mesh/mesh.h"

namespace trocar {

// An error where others hold all its nodes and move them otherwise;
// warns where they do so with some of its nodes, and where it adds nothing to them.
void check_supports(const Scene& scene, const Mesh& mesh, OptionErrors& errors);

}  // namespace trocar
