// Runs over the blocks of all lists of a model as if they were one list, so that threads share
// them evenly.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/threads.h"
#include "solver/kernels.h"
#include "solver/model.h"

namespace trocar {

inline std::int64_t count_blocks(const Model& model) {
  std::int64_t n = 0;
  for (const ElementBlocks& blocks : model.blocks) n += blocks.n_blocks;
  return n;
}

// Calls body(blocks, first, n) for the parts of the lists that lie in [begin, end).
template <class Body>
void for_block_range(const Model& model, std::int64_t begin, std::int64_t end, const Body& body) {
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t first = std::max<std::int64_t>(begin, 0);
    const std::int64_t last = std::min<std::int64_t>(end, blocks.n_blocks);
    if (first < last) body(blocks, first, last - first);
    begin -= blocks.n_blocks;
    end -= blocks.n_blocks;
  }
}

// parallel_for over nodes; fewer than a thousand are not worth waking threads for.
template <class Body>
void parallel_for_nodes(std::int64_t n, const Body& body) {
  constexpr std::int64_t group = 16;
  parallel_for((n + group - 1) / group, [&](std::int64_t begin, std::int64_t end) {
    body(begin * group, std::min(n, end * group));
  });
}

inline const BlockKernels& kernels_for(const Kernels& kernels, const ElementBlocks& blocks) {
  return kernels.of[static_cast<int>(blocks.precision)]
      .block[static_cast<int>(blocks.formulation)][static_cast<int>(blocks.material)];
}

inline BlockTask block_task(const Model& model, const ElementBlocks& blocks,
                            const BlockKernels& kernels, const State& state, std::int64_t first,
                            std::int64_t n) {
  const std::int64_t at = first * kernels.n_values * blocks.lanes;
  const bool is_single = blocks.precision == Precision::in_single;
  return {.u = state.u.data(),
          .corner = blocks.corner.data() + first * kernels.n_corners * blocks.lanes,
          .data = is_single ? static_cast<const void*>(blocks.data_single.data() + at)
                            : static_cast<const void*>(blocks.data.data() + at),
          .n_blocks = n,
          .theta = state.theta.data() + blocks.field,
          .n_fields = model.averages.n_fields,
          .element_share = model.options.element_share};
}

}  // namespace trocar
