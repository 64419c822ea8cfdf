// Where large parts of a body hang together by a few elements between cuts: as where strokes around
// a piece do not quite meet.
#pragma once

#include <vector>

#include "mesh/mesh.h"

namespace trocar {

struct CutBridge {
  Vec3 X = Vec3::Zero();  // its middle, reference configuration [m]
  double volume = 0;      // of the smallest part that hangs there [m^3]
};

// Short rims (of at most five nodes, where the two lips of opened facets meet) whose elements alone
// join parts of more than a few mean edges cubed, one of those a few edges apart. Of bodies in
// space; mean_edge [m].
std::vector<CutBridge> find_bridges(const Mesh& mesh, double mean_edge);

}  // namespace trocar
