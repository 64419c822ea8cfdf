// Places of corner forces at nodes that several runs of blocks meet (SumOrder).
#pragma once

#include <cstdint>
#include <span>

#include "solver/model.h"

namespace trocar {

// Of a node, in place of the one run that meets it.
inline constexpr std::int32_t no_run = -1, several_runs = -2;

// Whether the eight numbers follow each other.
bool are_consecutive(const std::int32_t* number);

// Fills targets and the places of model.sums; run (n_local) that meets each node.
void place_shared_corners(std::span<const std::int32_t> run, Model& model);

}  // namespace trocar
