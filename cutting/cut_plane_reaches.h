// Long paths of plane cuts in parts.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace trocar {

// The path in parts that one edit can lay each, from end to end: no part bends by 60 degrees or
// more at a point, or crosses itself. Where two legs compete for the same nodes, a cut in one edit
// gets too few of them.
std::vector<std::vector<Vec3>> reaches(std::span<const Vec3> path);

}  // namespace trocar
