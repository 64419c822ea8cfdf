// Which nodes hang together through elements: the pieces of a body, or groups of some elements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// (n_nodes) The lowest node that the node is connected with through the listed elements; the node
// itself where none of them touches it.
std::vector<std::int32_t> connected_nodes(const Mesh& mesh, std::span<const std::int32_t> elements);

}  // namespace trocar
