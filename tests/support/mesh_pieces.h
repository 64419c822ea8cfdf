// Pieces of a mesh whose elements share facets.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// The piece of each element, counted from 0 in the order of their first elements.
std::vector<std::int32_t> element_pieces(const Mesh& mesh);

std::int32_t n_pieces(const Mesh& mesh);

}  // namespace trocar
