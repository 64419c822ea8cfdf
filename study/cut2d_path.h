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

}  // namespace trocar
