// Forces: corner forces of blocks, and each owned node sums its corners in a fixed order. A thread
// takes a run of blocks and sums the nodes that no other thread's blocks touch as soon as they are
// complete, while their corner forces are in its cache; the few others are summed afterwards.
// Which nodes those are depends on the number of threads, their sums don't.
#include "solver/step.h"

#include <algorithm>

#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/history.h"
#include "solver/simd.h"

namespace trocar {

namespace {

// Blocks between two looks at the nodes: 256 elements in double, about 64 kB of corner forces.
constexpr std::int64_t stride_blocks = 32;

void* slot_at(const Model& model, Scratch& scratch, std::int64_t at) {
  return model.options.precision == Precision::in_single
             ? static_cast<void*>(scratch.slot_single.data() + at)
             : static_cast<void*>(scratch.slot.data() + at);
}

double* history_at(const ElementBlocks& blocks, std::int64_t block, State& state) {
  return state.history.data() + blocks.first_history + block * blocks.lanes * history_width(blocks);
}

void run_blocks(const Model& model, State& state, std::int64_t begin, std::int64_t end,
                Scratch& scratch) {
  const Kernels& kernels = active_kernels();
  for_block_range(
      model, begin, end, [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
        const BlockKernels& kernel = kernels_for(kernels, blocks);
        const std::int64_t slot = blocks.first_slot + first * kernel.n_corners * blocks.lanes;
        const BlockTask task = block_task(model, blocks, kernel, state, first, n);
        void* const to = slot_at(model, scratch, slot * slot_width);
        if (blocks.prony.empty()) return kernel.force(task, to);
        kernel.viscous_force(task, scratch.viscous[&blocks - model.blocks.data()],
                             history_at(blocks, first, state), to);
      });
}

// Nodes [begin, end) of the order of sums.
void sum_nodes(const Model& model, std::int64_t begin, std::int64_t end, Scratch& scratch) {
  const auto precision = static_cast<int>(model.options.precision);
  active_kernels().of[precision].sum({.slot = slot_at(model, scratch, 0),
                                      .slot_offset = model.slot_offset.data(),
                                      .slot_index = model.slot.data(),
                                      .mass = model.mass.data(),
                                      .gravity = model.options.gravity.data(),
                                      .force = scratch.force.data(),
                                      .node = model.sum_node.data() + begin,
                                      .n_nodes = end - begin});
}

// Sums the nodes of [begin, end) for which `is_due`, run by run.
template <class IsDue>
void sum_due_nodes(const Model& model, std::int64_t begin, std::int64_t end, const IsDue& is_due,
                   Scratch& scratch) {
  for (std::int64_t k = begin; k < end;) {
    const std::int64_t first = k;
    while (k < end && is_due(k)) ++k;
    if (k > first) sum_nodes(model, first, k, scratch);
    while (k < end && !is_due(k)) ++k;
  }
}

// The blocks [begin, end) of one thread, and the nodes that only they touch.
void compute_run(const Model& model, State& state, std::int64_t begin, std::int64_t end,
                 Scratch& scratch) {
  const std::vector<std::int32_t>& last = model.sum_last_block;
  std::int64_t k = std::lower_bound(last.begin(), last.end(), begin) - last.begin();
  const auto is_mine = [&](std::int64_t at) { return model.sum_first_block[at] >= begin; };
  for (std::int64_t block = begin; block < end; block += stride_blocks) {
    const std::int64_t next = std::min(end, block + stride_blocks);
    run_blocks(model, state, block, next, scratch);
    const std::int64_t first = k;
    for (; k < model.n_owned && last[k] < next; ++k)
      if (is_mine(k)) scratch.is_summed[model.sum_node[k]] = 1;
    sum_due_nodes(model, first, k, is_mine, scratch);
  }
}

void sum_remaining(const Model& model, Scratch& scratch) {
  parallel_for_nodes(model.n_owned, [&](std::int64_t begin, std::int64_t end) {
    const auto is_left = [&](std::int64_t k) { return scratch.is_summed[model.sum_node[k]] == 0; };
    sum_due_nodes(model, begin, end, is_left, scratch);
  });
  std::fill(scratch.is_summed.begin(), scratch.is_summed.end(), std::uint8_t{0});
}

}  // namespace

void compute_force(const Model& model, State& state, Scratch& scratch) {
  CHECK_OP(std::ssize(state.u), ==, 3 * std::int64_t{model.n_local});
  CHECK_OP(std::ssize(state.theta), ==, std::int64_t{model.n_local} * model.averages.n_fields);
  CHECK_OP(std::ssize(scratch.force), ==, 3 * std::int64_t{model.n_owned});
  CHECK_OP(std::ssize(state.history), ==, model.n_history);
  for (std::size_t k = 0; k < model.blocks.size(); ++k)
    if (!model.blocks[k].prony.empty())
      scratch.viscous[k] = viscous_step(model.blocks[k].prony, state.time - state.history_time);
  parallel_for(count_blocks(model), [&](std::int64_t begin, std::int64_t end) {
    compute_run(model, state, begin, end, scratch);
  });
  sum_remaining(model, scratch);
  state.history_time = state.time;
}

std::size_t memory_bytes(const Model& model, const Scratch& scratch) {
  const auto bytes = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  std::size_t sum =
      bytes(model.mass) + bytes(model.fixed) + bytes(model.slot_offset) + bytes(model.slot) +
      bytes(model.sum_node) + bytes(model.sum_first_block) + bytes(model.sum_last_block) +
      bytes(model.element_step) + bytes(model.averages.offset) + bytes(model.averages.lane) +
      bytes(model.averages.stiffness) + bytes(scratch.volume_change) + bytes(scratch.slot) +
      bytes(scratch.slot_single) + bytes(scratch.force) + bytes(scratch.is_summed);
  for (const ElementBlocks& blocks : model.blocks)
    sum += bytes(blocks.element_local) + bytes(blocks.corner) + bytes(blocks.data) +
           bytes(blocks.data_single);
  return sum;
}

}  // namespace trocar
