// A place of a blade's edge in the tissue, as it is in the reference configuration.
#pragma once

#include <span>

#include "engine/locate.h"

namespace trocar {

struct EdgePlace {
  Vec3 X, along, ahead;  // of the edge and its way, unit
  double size = 0;       // of the element [m]

  Vec3 normal() const { return along.cross(ahead).normalized(); }
};
// x (n_nodes) present positions, in which along and ahead are given.
EdgePlace place_of(const Mesh& mesh, std::span<const Vec3> x, const Location& at, const Vec3& along,
                   const Vec3& ahead);

}  // namespace trocar
