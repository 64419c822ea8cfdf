// Two measures of a mesh that several stages need.
#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// Mean length of the unique edges, in the reference configuration. [m]
double mean_edge_length(const Mesh& mesh);
// (n_regions) Files name regions, too, that have none.
std::vector<std::int64_t> elements_by_region(const Mesh& mesh);
// x = X + u for all nodes; u (n_nodes * 3). [m]
std::vector<Vec3> present_positions(std::span<const Vec3> X, std::span<const double> u);

}  // namespace trocar
