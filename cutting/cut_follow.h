// What a stroke forgets where another blade has parted the tissue.
#pragma once

#include "cutting/cut_stroke.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// Crossings of edges whose ends the edit has parted, and all those in elements at facets that it
// opened: made again, they would be a second slit beside the first. Elements of those of this
// stroke go to in_slit. `mesh` is that before the edit.
void forget_parted(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke);

}  // namespace trocar
