// The paper's point of comparison (row OR of Table 1): a new node wherever the cut meets an edge.
#pragma once

#include <span>

#include "base/vec.h"
#include "mesh/mesh.h"

namespace trocar {

// Splits every triangle that the straight cut from a to b meets into three, along the whole line,
// and opens the cut: nodes on it are doubled but for those at its inner ends. There the triangle
// beyond stays whole, so that these two nodes hang: this alone gives the paper's numbers of nodes
// and elements. The quadrilaterals are halved by a fixed rule of local numbers, not by shape, which
// is what the paper's sigma of areas asks for. Throws InputError for other elements than tri3.
Mesh subdivide_along(const Mesh& mesh, const Vec3& a, const Vec3& b);

}  // namespace trocar
