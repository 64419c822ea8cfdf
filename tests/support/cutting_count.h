// Pieces of a body, and how many random cuts to try.
#pragma once

#include <cstdint>

#include "mesh/mesh.h"

namespace trocar {

// Connected through facets.
std::int32_t n_pieces(const Mesh& mesh);

// What TROCAR_CUTS says, or else `otherwise`.
int n_cuts_or(int otherwise);

}  // namespace trocar
