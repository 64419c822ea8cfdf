#include "solver/prefetch.h"

#include <algorithm>

#include "solver/block_ranges.h"
#include "solver/sum_order.h"

namespace trocar {

namespace {

// What a third-level cache holds of a body: below it, prefetches only cost (4 % of a step).
constexpr std::size_t cached_bytes = 16 << 20;

constexpr std::uintptr_t line_bytes = 64;

// Compilers leave out calls of functions that do nothing but __builtin_prefetch.
template <class T>
void fetch(const T* first, std::int64_t n) {
  auto line = reinterpret_cast<std::uintptr_t>(first) / line_bytes * line_bytes;
  for (const auto end = reinterpret_cast<std::uintptr_t>(first + n); line < end; line += line_bytes)
    asm volatile("prefetcht0 (%0)" ::"r"(line));
}

std::int32_t share_of(std::int32_t n) {
  return static_cast<std::int32_t>((n + stride_blocks - 1) / stride_blocks);
}

}  // namespace

NodeRange RunPrefetch::Share::take(std::int64_t n_blocks) {
  const auto n =
      static_cast<std::int32_t>(std::min<std::int64_t>(per_block * n_blocks, end - next));
  if (n <= 0) return {};
  next += n;
  return {next - n, next};
}

RunPrefetch::RunPrefetch(const Model& model, std::int64_t run, const State& state,
                         const Scratch& scratch)
    : model_(model),
      state_(state),
      scratch_(scratch),
      end_stride_(model.sums.run_stride[run + 1]),
      is_on_(memory_bytes(model, scratch) + 2 * sizeof(double) * state.u.size() > cached_bytes) {}

void RunPrefetch::start(std::int32_t stride) {
  if (!is_on_) return;
  const SumOrder& sums = model_.sums;
  const std::int32_t first = sums.stride_first[stride], end = sums.stride_first[stride + 1];
  finished_ = {first, end, share_of(end - first)};
  met_ = {};
  if (stride + 1 == end_stride_ || stride + 1 >= std::ssize(sums.stride_nodes)) return;
  const std::int32_t known = sums.stride_nodes[stride].end, all = sums.stride_nodes[stride + 1].end;
  met_ = {known, all, share_of(all - known)};
}

void RunPrefetch::beside(const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
  if (!is_on_) return;
  fetch_met(met_.take(n));
  fetch_finished(finished_.take(n));
  if (model_.is_by_component) return;  // most blocks have short lists
  const std::int64_t n_corners = corners_of_block(blocks);
  const std::int64_t next = std::min<std::int64_t>(first + 2 * n, blocks.n_blocks);
  const std::int64_t n_next = std::min<std::int64_t>(n, blocks.n_blocks - next);
  fetch(blocks.corner.data() + next * n_corners, n_next * n_corners);
}

void RunPrefetch::fetch_met(const NodeRange& nodes) const {
  const std::int64_t first = nodes.begin, n = nodes.end - nodes.begin;
  if (n == 0) return;
  fetch(state_.u.data() + 3 * first, 3 * n);
  for (int j = 0; j < 3; ++j) {
    if (!model_.position.empty())
      fetch(model_.position.data() + j * component_stride(model_.n_local) + first, n);
    if (scratch_.sum.empty())
      fetch(scratch_.sum_single.data() + j * sum_stride(model_) + first, n);
    else
      fetch(scratch_.sum.data() + j * sum_stride(model_) + first, n);
  }
}

// Where they follow each other.
void RunPrefetch::fetch_finished(const NodeRange& positions) const {
  const std::int64_t n = positions.end - positions.begin;
  if (n == 0) return;
  const std::int64_t node = model_.sums.node[positions.begin];
  if (model_.sums.node[positions.end - 1] - node != n - 1) return;
  fetch(state_.v.data() + 3 * node, 3 * n);
  fetch(inertia_of(model_).data() + node, n);
}

}  // namespace trocar
