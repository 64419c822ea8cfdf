// What a hexahedron with displaced corners is still good for.
#pragma once

#include <array>

#include "base/vec.h"

namespace trocar {

// In the measure of step_bound (cut_patch.h): V / sqrt(2 sum |dV/dx_a|^2). The bound of an element
// of n corners with one point is 2 V / (c sqrt(n sum |dV/dx_a|^2)) (Flanagan and Belytschko 1984);
// step_bound has n = 4 in it. [m]
double hex_step_bound(const std::array<Vec3, 8>& X);

// Least Jacobian of the 2 x 2 x 2 Gauss points over that of the centre. (The corners' Jacobians
// vanish where two facets of a cut lie in one plane, which harms neither rule of integration.)
double least_gauss_ratio(const std::array<Vec3, 8>& X);

}  // namespace trocar
