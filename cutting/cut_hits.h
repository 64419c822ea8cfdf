// Which element edges a swept band crosses, and where.
#pragma once

#include "cutting/blade_sweep.h"
#include "cutting/cut_index.h"
#include "cutting/cut_positions.h"
#include "cutting/cut_stroke.h"
#include "mesh/mesh.h"

namespace trocar {

// Adds the crossings of the band with the edges of tetrahedra in the present configuration to
// stroke.hit; an edge crossed back loses its crossing. The band begins where the last one ended in
// the tissue, and a little behind. Every element that shares an edge gets the same decision. Sets
// stroke.mean_edge near the band and adds the way in the tissue to stroke.swept. `index` is that of
// the mesh.
void add_hits(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
              const BladeSweep& sweep, CutStroke& stroke);

}  // namespace trocar
