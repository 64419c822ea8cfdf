// What solver/prefetch does for the program's step, for schemes of passes over elements alone: of
// bodies that no cache holds, lines of nodes that the next stride meets first are asked for.
#pragma once

#include <algorithm>
#include <array>

#include "bench/step_schemes.h"
#include "solver/node_layout.h"
#include "solver/sum_order.h"

namespace trocar {

class NodePrefetch {
 public:
  NodePrefetch(const Body& body, const SchemeData& data, std::int32_t run, bool adds_to_sums)
      : met_end_(data.met_end),
        end_of_run_(body.model.sums.run_stride[run + 1]),
        is_on_(body.scratch.is_beyond_cache),
        has_corners_(!body.model.is_by_component) {
    const Model& model = body.model;
    if (model.is_by_component)
      add_field(data.u_x.data(), component_stride(model.n_local));
    else
      add_field(body.state.u.data(), 0, 3);
    if (!model.position.empty())
      add_field(model.position.data(), has_corners_ ? 0 : component_stride(model.n_local));
    if (adds_to_sums) {
      if (model.options.precision == Precision::in_single)
        add_field(body.scratch.sum_single.data(), sum_stride(model));
      else
        add_field(body.scratch.sum.data(), sum_stride(model));
    }
  }

  void start(std::int32_t stride) {
    next_ = data_end(stride);
    end_ = stride + 1 < end_of_run_ ? data_end(stride + 1) : next_;
    if (end_ - next_ > most_met) end_ = next_;
    per_block_ = (end_ - next_ + std::int32_t{stride_blocks} - 1) / std::int32_t{stride_blocks};
  }

  // Blocks [first, first + n) of the list are computed now.
  void beside(const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
    if (!is_on_) return;
    const auto n_nodes = std::min(per_block_ * static_cast<std::int32_t>(n), end_ - next_);
    for (int k = 0; k < n_fields_ && n_nodes > 0; ++k)
      fetch(field_[k].at + next_ * field_[k].node_bytes, n_nodes * field_[k].node_bytes);
    next_ += n_nodes;
    if (!has_corners_) return;
    const std::int64_t next = std::min<std::int64_t>(first + 2 * stride_blocks, blocks.n_blocks);
    const std::int64_t of_block = corners_of_block(blocks) * std::int64_t{sizeof(std::int32_t)};
    fetch(reinterpret_cast<const char*>(blocks.corner.data()) + next * of_block,
          std::min<std::int64_t>(n, blocks.n_blocks - next) * of_block);
  }

 private:
  struct Field {
    const char* at = nullptr;
    std::int64_t node_bytes = 0;
  };
  static constexpr std::int32_t most_met = 4096;  // what is more is no row of nodes
  std::span<const std::int32_t> met_end_;
  std::int32_t end_of_run_;
  bool is_on_, has_corners_;
  std::array<Field, 9> field_;
  int n_fields_ = 0;
  std::int32_t next_ = 0, end_ = 0, per_block_ = 0;

  std::int32_t data_end(std::int32_t stride) const { return met_end_[std::size_t(stride)]; }
  // By component, or with so many numbers a node.
  template <class Real>
  void add_field(const Real* at, std::int64_t stride, std::int64_t n = 4) {
    const std::int64_t n_parts = stride > 0 ? 3 : 1, bytes = sizeof(Real);
    for (std::int64_t j = 0; j < n_parts; ++j)
      field_[std::size_t(n_fields_++)] = {reinterpret_cast<const char*>(at + j * stride),
                                          stride > 0 ? bytes : n * bytes};
  }
  static void fetch(const char* first, std::int64_t n) {
    constexpr std::int64_t line = 64;
    for (std::int64_t k = 0; k < n; k += line) asm volatile("prefetcht0 (%0)" ::"r"(first + k));
  }
};

}  // namespace trocar
