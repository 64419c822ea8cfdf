// How bodies move: gravity, momentum, differences of displacements.
#pragma once

#include <vector>

#include "engine/simulation.h"

namespace trocar {

inline constexpr double g = 9.81;  // [m/s^2]

// Of the masses without what scaling adds. [kg m/s]
Vec3 momentum(const Simulation& s);

// Infinite between fields of different sizes.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace trocar
