// Where a point is in a tetrahedron or triangle, and what a field has there.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/vec.h"

namespace trocar {

// Weights of the corners of a tetrahedron or, in the plane z = 0, a triangle (the last one 0),
// whose sum is 1: they give p. All are positive within. x: positions of all nodes. NaN where it is
// flat.
std::array<double, 4> barycentric(std::span<const std::int32_t> corner, std::span<const Vec3> x,
                                  const Vec3& p);

// The value there of a nodal field: sum_a weight[a] field[corner a].
Vec3 interpolate(std::span<const std::int32_t> corner, std::span<const double> weight,
                 std::span<const Vec3> field);

}  // namespace trocar
