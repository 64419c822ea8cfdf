// Paths of plane cuts as text.
#pragma once

#include <string>
#include <vector>

#include "study/cut2d_trial.h"

namespace trocar {

// "x,y x,y …" in mm, at least two different points. Throws InputError.
Cut2dPath read_path(const std::string& text);
// The arc through three points "x,y x,y x,y" in mm as a polyline of 64 segments; the line if they
// lie on one. Throws InputError.
Cut2dPath read_arc(const std::string& text);

// The path in parts that one edit can lay each, from end to end: no part bends by 60 degrees or
// more at a point, or crosses itself. Where two legs compete for the same nodes, a cut in one edit
// gets too few of them.
std::vector<Cut2dPath> reaches(const Cut2dPath& path);

}  // namespace trocar
