// How bodies move: gravity, momentum, differences of displacements.
#pragma once

#include "engine/simulation.h"
#include "largest.h"

namespace trocar {

inline constexpr double g = 9.81;  // [m/s^2]

// Of the masses without what scaling adds. [kg m/s]
Vec3 momentum(const Simulation& s);

}  // namespace trocar
