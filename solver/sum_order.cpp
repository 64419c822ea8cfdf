// First and last block of each owned node, then a counting sort by the last.
#include "solver/sum_order.h"

#include <algorithm>
#include <limits>

namespace trocar {

void order_sums(Model& model) {
  const auto n = static_cast<std::size_t>(model.n_owned);
  std::vector<std::int32_t> first(n, std::numeric_limits<std::int32_t>::max()), last(n, 0);
  std::int32_t n_blocks = 0;
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t stride = std::ssize(blocks.corner) / blocks.n_blocks;
    for (std::int64_t k = 0; k < std::ssize(blocks.corner); ++k) {
      const std::int32_t i = blocks.corner[k];
      if (i >= model.n_owned) continue;
      const auto block = static_cast<std::int32_t>(n_blocks + k / stride);
      first[i] = std::min(first[i], block);
      last[i] = block;
    }
    n_blocks += blocks.n_blocks;
  }
  std::vector<std::int32_t> next(static_cast<std::size_t>(n_blocks) + 1, 0);
  for (const std::int32_t block : last) ++next[block + 1];
  for (std::int32_t block = 0; block < n_blocks; ++block) next[block + 1] += next[block];
  model.sum_node.resize(n);
  model.sum_first_block.resize(n);
  model.sum_last_block.resize(n);
  for (std::int32_t i = 0; i < model.n_owned; ++i) {
    const std::int32_t at = next[last[i]]++;
    model.sum_node[at] = i;
    model.sum_first_block[at] = first[i];
    model.sum_last_block[at] = last[i];
  }
}

}  // namespace trocar
