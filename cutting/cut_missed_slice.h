// Slices thinner than the mesh can show: between a blade and nodes of the outer surface that can't
// go to it, all elements stay on the blade's other side, and nothing is opened.
#pragma once

#include <vector>

#include "cutting/cut_figures.h"
#include "cutting/cut_stroke.h"
#include "cutting/cut_surroundings.h"
#include "mesh/mesh.h"

namespace trocar {

// Of a stroke that has gone through and remembers its last edit of `mesh` (not applied yet): one
// refusal for each connected stretch of a slice that stays joined, with its area.
std::vector<CutRefusal> missed_slices(const Mesh& mesh, const CutSurroundings& around,
                                      const CutStroke& stroke);

}  // namespace trocar
