// Paths of plane cuts that run in a slit which is there already.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "mesh/mesh.h"

namespace trocar {

// What of a path is still to be cut: it begins where it leaves the slit, at the slit's tip or at a
// lip, and is one point where it ends in the slit.
struct PathFromSlit {
  std::vector<Vec3> point;  // reference configuration [m]
  std::int32_t tip = -1;    // node that it begins at, -1: none
};
// `tip`: the node that `path` begins at, or -1. h: mean edge length [m]. As near as 0.3 h beside a
// slit the blade is in it: what lies between is no piece that could be cut off.
PathFromSlit past_slit(const Mesh& mesh, std::span<const Vec3> path, std::int32_t tip, double h);
// What of a path that has left its slit lies before another one that it ends in; all of it if it
// ends in none. Its end may lie at the tip that it begins at.
std::vector<Vec3> before_slit(const Mesh& mesh, const PathFromSlit& path, double h);

}  // namespace trocar
