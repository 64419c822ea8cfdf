// What a partition costs in each step: kernels take eight elements at a time, and are quickest
// where these stand in a row, their nodes one behind the other at each corner.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace trocar {

// A corner's share of its element's step, in the ratio of docs/performance.md: a one-point
// hexahedron takes some 2.7 times as long as a tetrahedron, a triangle 1.25 times.
int corner_work(ElementType type);

// Work of the elements of the part that has most, those computed by several parts in each of them.
double most_work(const Mesh& mesh, std::span<const std::int32_t> node_owner, int n_parts);

}  // namespace trocar
