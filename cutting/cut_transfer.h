// How moved nodes take their state along, and how far they may go so that the body stays valid in
// its present shape too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_patch.h"

namespace trocar {

// Where moved nodes stand in the old mesh; numbers local.
struct NodeTransfer {
  std::int32_t node = 0;
  std::int32_t host = 0;
  std::array<double, 4> weight{};
};

// Nodes of `X` (n_nodes) that differ from the patch's, with hosts. Moves that leave an element
// without volume, in X or in the present configuration, or that no element hosts, are halved until
// they don't; X is set to what is left.
std::vector<NodeTransfer> transfer_moves(const CutPatch& patch, std::vector<Vec3>& X);

// Local elements around the nodes of `transfer`, ascending.
std::vector<std::int32_t> elements_around(const CutPatch& patch,
                                          std::span<const NodeTransfer> transfer);

}  // namespace trocar
