// Runs over the blocks of all lists of a model as if they were one list, so that threads share
// them evenly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/threads.h"
#include "solver/flush_subnormals.h"
#include "solver/kernels.h"
#include "solver/model.h"
#include "solver/node_layout.h"
#include "solver/row_order.h"
#include "solver/simd.h"
#include "solver/stash.h"

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

// The kernels of one list.
struct BlockKernels {
  const ElementKernels& element;
  const LawKernels& law;
  int n_material_values;
  int n_values;  // of an element in all
};

inline BlockKernels kernels_for(const Kernels& kernels, const ElementBlocks& blocks) {
  const KernelsOfPrecision& of = kernels.of[static_cast<int>(blocks.precision)];
  const ElementKernels& element = of.element[static_cast<int>(blocks.formulation)];
  const int model = static_cast<int>(blocks.material);
  const int n = kernels.n_material_values[model];
  return {element, of.law[static_cast<int>(element.law)][model], n, n + element.n_values};
}

// Blocks that go through the stash together, at most; fewer of large elements, so that stash and
// constants (a cache line a value) leave the nodes room in the cache: with 8 in place of 4
// one-point hexahedra took 9 % longer.
inline constexpr std::int64_t stash_blocks = 8;
inline std::int64_t blocks_at_once(const BlockKernels& kernels) {
  constexpr std::int64_t values_in_cache = 16384 / 64;
  const std::int64_t n = values_in_cache / (kernels.n_values + kernels.element.n_stash);
  return std::clamp<std::int64_t>(n, 1, stash_blocks);
}
inline constexpr int max_stash_values = tensor_values * 8;
struct alignas(64) StashBytes {
  std::byte byte[64 * max_stash_values * stash_blocks];
};

// Displacements by component: component i of local node k at x[i * stride + k]; null: none.
struct Components {
  const double* x = nullptr;
  std::int64_t stride = 0;
};

// On by n blocks of the list. What it has no use for is empty.
inline void advance(const ElementBlocks& blocks, const BlockKernels& kernels, std::int64_t n,
                    BlockTask& task) {
  const std::int64_t n_corners = n * kernels.element.n_corners;
  task.corner += n_corners * blocks.lanes;
  task.row += n * blocks.lanes / row_lanes;
  if (!blocks.row_break.empty()) {
    task.row_break += n;
    task.row_start += n_corners;
    task.row_target += n_corners;
  }
  const std::int64_t n_values = n * kernels.n_values * blocks.lanes;
  if (blocks.precision == Precision::in_single)
    task.data = static_cast<const float*>(task.data) + n_values;
  else
    task.data = static_cast<const double*>(task.data) + n_values;
}

inline BlockTask block_task(const Model& model, const ElementBlocks& blocks,
                            const BlockKernels& kernels, const State& state,
                            const Components& components, std::int64_t first, std::int64_t n,
                            StashBytes& stash) {
  const bool is_single = blocks.precision == Precision::in_single;
  const ElementKernels& element = kernels.element;
  const bool averages = element.volume_change != nullptr;
  const int share = element.share > 0 ? kernels.n_material_values + element.share : 0;
  BlockTask task{
      .u = state.u.data(),
      .u_x = components.x,
      .u_stride = components.stride,
      .position = model.position.data(),
      .position_stride = model.is_by_component ? component_stride(model.n_local) : 0,
      .corner = blocks.corner.data(),
      .row = blocks.row.data(),
      .row_break = blocks.row_break.data(),
      .row_start = blocks.row_start.data(),
      .row_target = (blocks.row_target.empty() ? blocks.row_start : blocks.row_target).data(),
      .data = is_single ? static_cast<const void*>(blocks.data_single.data())
                        : static_cast<const void*>(blocks.data.data()),
      .n_blocks = n,
      .n_values = kernels.n_values,
      .n_material_values = kernels.n_material_values,
      .stash = stash.byte,
      .n_points = element.n_points,
      .n_stash = element.n_stash,
      .share = share,
      .share_stride = element.share_stride,
      .theta = state.theta.data() + blocks.field,
      .n_fields = model.averages.n_fields,
      .element_share = averages ? model.averages.share[blocks.field] : 0,
      .sum_stride = sum_stride(model)};
  advance(blocks, kernels, first, task);
  return task;
}

inline bool is_aligned(const ElementBlocks& blocks, std::int64_t block) {
  return blocks.n_aligned > 0 && is_aligned(blocks.row_break[block]);
}

// How many blocks from `block` on, at most n, make one task: their targets follow each other, and
// all are aligned or none.
inline std::int64_t n_of_task(const ElementBlocks& blocks, std::int64_t block, std::int64_t n) {
  const bool has_targets = !blocks.target_block.empty();
  if (!has_targets && (blocks.n_aligned == 0 || blocks.n_aligned == blocks.n_blocks)) return n;
  const auto kind_of = [&](std::int64_t k) {
    return std::pair(is_aligned(blocks, k), has_targets && blocks.target_block[k] >= 0);
  };
  std::int64_t k = 1;
  while (k < n && kind_of(block + k) == kind_of(block)) ++k;
  return k;
}

// Calls body(kernels, task, block) for the blocks [first, first + n) of a list, some at a time,
// with their strains in the stash; block is the first of them.
template <class Body>
void for_strained_blocks(const Model& model, const ElementBlocks& blocks, const State& state,
                         const Components& components, std::int64_t first, std::int64_t n,
                         const Body& body) {
  StashBytes stash;
  const FlushSubnormals flush(blocks.precision == Precision::in_single);
  const BlockKernels kernels = kernels_for(active_kernels(), blocks);
  const std::int64_t step = blocks_at_once(kernels);
  BlockTask task = block_task(model, blocks, kernels, state, components, first, step, stash);
  for (std::int64_t at = first; at < first + n; at += task.n_blocks) {
    task.n_blocks = n_of_task(blocks, at, std::min(step, first + n - at));
    task.is_aligned = components.x != nullptr && is_aligned(blocks, at);
    kernels.element.strain(task);
    body(kernels, task, at);
    advance(blocks, kernels, task.n_blocks, task);
  }
}
template <class Body>
void for_strained_blocks(const Model& model, const ElementBlocks& blocks, const State& state,
                         std::int64_t first, std::int64_t n, const Body& body) {
  for_strained_blocks(model, blocks, state, {}, first, n, body);
}

// The same for the blocks in [begin, end) of all lists, with their list first.
template <class Body>
void for_strained_block_range(const Model& model, const State& state, std::int64_t begin,
                              std::int64_t end, const Body& body) {
  for_block_range(
      model, begin, end, [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
        for_strained_blocks(model, blocks, state, first, n,
                            [&](const BlockKernels& kernels, const BlockTask& task,
                                std::int64_t block) { body(blocks, kernels, task, block); });
      });
}

}  // namespace trocar
