// What a partition costs in each step: kernels take eight elements at a time, and are quickest
// where these stand in a row, their nodes one behind the other at each corner.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace trocar {

// Weight of a corner for the work of a step: a one-point hexahedron (8 x 4) counts for 2.7
// tetrahedra (4 x 3), a triangle (3 x 5) for 1.25. Measured are 2.2 to 2.5 and 1.0 to 1.1 with
// AVX-512, 1.9 to 3.0 and 0.8 to 0.9 with less (docs/performance-measured.md).
int corner_work(ElementType type);

// Work of the elements of the part that has most, those computed by several parts in each of them.
double most_work(const Mesh& mesh, std::span<const std::int32_t> node_owner, int n_parts);

}  // namespace trocar
