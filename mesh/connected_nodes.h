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
// The same through all elements: the piece of each node.
std::vector<std::int32_t> connected_nodes(const Mesh& mesh);

// Pieces that hang together through nodes. Where no two pieces touch in a node or an edge alone, as
// after every cut, these are the pieces that hang together through facets.
std::int32_t count_pieces(const Mesh& mesh);
// The same from the piece of each node.
std::int32_t count_pieces(std::span<const std::int32_t> piece);

// Nodes that lie where a node of another piece does, but for rounding to multiples of `tolerance`
// [m]: facets that were meant to be joined, as a rule. piece: of each node.
std::int32_t count_unjoined(const Mesh& mesh, std::span<const std::int32_t> piece,
                            double tolerance);

}  // namespace trocar
