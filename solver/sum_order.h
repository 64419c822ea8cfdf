// The order in which a step adds up the corner forces of nodes.
#pragma once

#include "solver/model.h"

namespace trocar {

// Fills model.sums and the lists' targets; the model has its blocks and nodes. As many runs as
// there are threads now.
void order_sums(Model& model);

// Where the corner forces of a list are added.
inline const std::vector<std::int32_t>& targets(const ElementBlocks& blocks) {
  return blocks.target.empty() ? blocks.corner : blocks.target;
}

// First block of a run.
inline std::int64_t first_block_of_run(std::int64_t run, std::int64_t n_runs,
                                       std::int64_t n_blocks) {
  return run * n_blocks / n_runs;
}

}  // namespace trocar
