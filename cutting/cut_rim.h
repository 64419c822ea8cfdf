// Where a stroke's swept surface ends inside the tissue, and where it only did for a while.
#pragma once

#include "cutting/cut_stroke.h"
#include "mesh/mesh.h"

namespace trocar {

// Takes points off the rim that the blade, or an earlier stroke that this one goes on with, has
// passed on both sides of it.
void drop_covered_rim(CutStroke& stroke);

// Forgets what strokes of this mean edge [m] have left, but around their ends: their rims, and what
// they have crossed and not parted. Or each frame would bear all that was ever cut.
void keep_ends(double h, CutLeft& left);

// What keep_ends forgets of the sides of elements that the stroke, which has ended, has not
// crossed.
void forget_uncrossed(const Mesh& mesh, CutStroke& stroke);

}  // namespace trocar
