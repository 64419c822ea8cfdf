// The reference shape of a hexahedron in the modes of hex8_modes.h: X = sum_m S_m x_m.
#pragma once

#include <array>
#include <span>

#include "base/vec.h"
#include "solver/hex8_modes.h"

namespace trocar {

using HexModes = std::array<Vec3, n_hex_modes>;

// S_m,a
int hex_mode_sign(int m, int a);

// sum_a S_m,a X_a, from differences to the first corner.
HexModes position_modes(std::span<const Vec3> X);

// Exact volume of the trilinear element with the modes x_m:
//   V = 8 ([x0 x1 x2] + ([x4 x3 x2] + [x5 x1 x3] + [x0 x5 x4]) / 3)
double hexahedron_volume(const HexModes& x);
// dV/dx_m / 8
HexModes volume_gradient(const HexModes& x);

}  // namespace trocar
