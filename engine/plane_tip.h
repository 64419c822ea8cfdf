// Where a blade's edge is in a plane body, which lies from half its thickness below z = 0 to half
// of it above.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/blade_sweep.h"

namespace trocar {

// What the edge cuts with: where it goes through z = 0, or the end of it that comes nearest. That
// has z = 0 within the body, otherwise it stays where it is.
Vec3 tip_in_plane(std::span<const Vec3> edge, double thickness);

// Of sweeps of such a tip: where it was at the frame's begin, as the tissue sees it.
Vec3 first_tip(const BladeSweep& sweep);

// From the way's begin to its end, not farther apart than `spacing` [m].
std::vector<Vec3> way_of_tip(const BladeSweep& sweep, double spacing);

}  // namespace trocar
