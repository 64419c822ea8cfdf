// Whether a material's stress grows with its strain, as constants fitted to tests may fail to have
// it: where stress falls, the tangent loses ellipticity and tissue gives way without end.
#pragma once

#include <string>

#include "solver/material.h"

namespace trocar {

// Looked at: stretches along an axis, across its free sides, and simple shears, all at constant
// volume.
inline constexpr double least_stretch = 0.7, largest_stretch = 1.5, largest_shear = 0.5;

// Where the stress of these falls first, as a sentence; "" where it grows all the way, and for the
// laws linear and st-venant-kirchhoff, which have no constants to choose.
std::string softening_of(const Material& material);

}  // namespace trocar
