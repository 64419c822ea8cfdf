#include "solver/prefetch.h"

#include <algorithm>

#include "solver/block_ranges.h"
#include "solver/step.h"
#include "solver/sum_order.h"

namespace trocar {

namespace {

// What a third-level cache holds of a body: below it, prefetches only cost (4 to 6 % of a step).
constexpr std::size_t cached_bytes = 20 << 20;

// Nodes that a stride meets first, or finishes; what is more is no row of them.
constexpr std::int32_t most_met = 4096;

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

bool is_beyond_cache(const Model& model, const Scratch& scratch) {
  const std::size_t of_state = 2 * 3 * sizeof(double) * static_cast<std::size_t>(model.n_local);
  return memory_bytes(model, scratch) + of_state > cached_bytes;
}

RunPrefetch::RunPrefetch(const Model& model, std::int64_t run, const State& state,
                         const Scratch& scratch)
    : model_(model), state_(state), scratch_(scratch), run_(run), is_on_(scratch.is_beyond_cache) {}

void RunPrefetch::start(std::int32_t stride) {
  if (!is_on_) return;
  const SumOrder& sums = model_.sums;
  const std::int32_t first = sums.stride_first[stride], end = sums.stride_first[stride + 1];
  finished_ = {};  // a whole run's nodes come by themselves
  if (end - first <= most_met) finished_ = {first, end, share_of(end - first)};
  const std::int32_t met = std::max(met_end_, end_of_nodes(stride + 1));
  met_ = {};
  if (met - met_end_ <= most_met) met_ = {met_end_, met, share_of(met - met_end_)};
  met_end_ = met;
}

std::int32_t RunPrefetch::end_of_nodes(std::int32_t stride) const {
  const SumOrder& sums = model_.sums;
  if (stride >= sums.run_stride[run_ + 1]) return 0;
  if (stride < std::ssize(sums.stride_nodes)) return sums.stride_nodes[stride].own.end;
  const std::int64_t first =
      sums.run_block[run_] + (stride - sums.run_stride[run_]) * stride_blocks;
  std::int32_t end = 0;
  for_block_range(model_, first, std::min(first + stride_blocks, sums.run_block[run_ + 1]),
                  [&](const ElementBlocks& blocks, std::int64_t begin, std::int64_t n) {
                    const std::int64_t n_corners = corners_of_block(blocks);
                    const std::int32_t* const corner = blocks.corner.data() + begin * n_corners;
                    for (std::int64_t k = 0; k < n * n_corners; k += blocks.lanes)
                      end = std::max(end, corner[k] + 1);
                  });
  return end;
}

void RunPrefetch::beside(const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
  if (!is_on_) return;
  fetch_met(met_.take(n));
  fetch_finished(finished_.take(n));
  if (model_.is_by_component) return;  // most blocks have short lists
  const std::int64_t n_corners = corners_of_block(blocks);
  const std::int64_t next = std::min<std::int64_t>(first + 2 * stride_blocks, blocks.n_blocks);
  const std::int64_t n_next = std::min<std::int64_t>(n, blocks.n_blocks - next);
  fetch(blocks.corner.data() + next * n_corners, n_next * n_corners);
}

// Of a nodal field by component, or else node by node in fours.
template <class Real>
void RunPrefetch::fetch_field(const AlignedVector<Real>& field, std::int64_t stride,
                              const NodeRange& nodes) const {
  const std::int64_t first = nodes.begin, n = nodes.end - nodes.begin;
  if (field.empty()) return;
  if (!model_.is_by_component) return fetch(field.data() + 4 * first, 4 * n);
  for (std::int64_t j = 0; j < 3; ++j) fetch(field.data() + j * stride + first, n);
}

void RunPrefetch::fetch_met(const NodeRange& nodes) const {
  if (nodes.begin == nodes.end) return;
  fetch(state_.u.data() + 3 * std::int64_t{nodes.begin}, 3 * std::int64_t{nodes.end - nodes.begin});
  fetch_field(model_.position, component_stride(model_.n_local), nodes);
  fetch_field(scratch_.sum, sum_stride(model_), nodes);
  fetch_field(scratch_.sum_single, sum_stride(model_), nodes);
}

void RunPrefetch::fetch_finished(const NodeRange& positions) const {
  const std::int32_t* const node = model_.sums.node.data();
  const auto fetch_nodes = [&](std::int64_t first, std::int64_t n) {
    fetch(state_.v.data() + 3 * first, 3 * n);
    fetch(inertia_of(model_).data() + first, n);
  };
  const std::int32_t n = positions.end - positions.begin;
  if (n > 0 && node[positions.end - 1] - node[positions.begin] == n - 1)
    return fetch_nodes(node[positions.begin], n);
  for (std::int32_t k = positions.begin; k < positions.end; ++k) fetch_nodes(node[k], 1);
}

}  // namespace trocar
