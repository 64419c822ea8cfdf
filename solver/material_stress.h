// The stress of a material at one point: for what is told of a body, not for its steps.
#pragma once

#include "base/vec.h"
#include "solver/material.h"

namespace trocar {

// First Piola-Kirchhoff stress at the displacement gradient H = F - I, of the law alone: without
// what relaxes. fibre: unit vector, see unit_fibre. [Pa]
Mat3 first_piola_stress(const Material& material, const Vec3& fibre, const Mat3& H);

}  // namespace trocar
