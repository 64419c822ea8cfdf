// Cache lines that the next blocks and nodes of a run need, asked for while the blocks before them
// are computed: of bodies that no cache holds. The nodes' many short streams leave the machine's
// own prefetchers behind, so that a core would wait for memory in nearly every block
// (docs/performance.md).
#pragma once

#include "solver/model.h"

namespace trocar {

// Whether no cache holds what a step reads and writes.
bool is_beyond_cache(const Model& model, const Scratch& scratch);

class RunPrefetch {
 public:
  RunPrefetch(const Model& model, std::int64_t run, const State& state, const Scratch& scratch);

  // The stride's blocks come next, or what of them does not sleep.
  void start(std::int32_t stride);
  // Blocks [first, first + n) of the list are computed now.
  void beside(const ElementBlocks& blocks, std::int64_t first, std::int64_t n);

 private:
  // Ascending nodes, some for each block of the stride.
  struct Share {
    std::int32_t next = 0, end = 0, per_block = 0;

    NodeRange take(std::int64_t n_blocks);
  };

  // Behind the nodes that the stride meets, by each block's first lane; 0: the run has no such one.
  std::int32_t end_of_nodes(std::int32_t stride) const;
  template <class Real>
  void fetch_field(const AlignedVector<Real>& field, std::int64_t stride,
                   const NodeRange& nodes) const;
  void fetch_met(const NodeRange& nodes) const;
  void fetch_finished(const NodeRange& positions) const;

  const Model& model_;
  const State& state_;
  const Scratch& scratch_;
  std::int64_t run_;
  bool is_on_;
  std::int32_t met_end_ = 0;  // behind the nodes that strides up to the next one meet
  Share met_;                 // nodes that the next stride meets first
  Share finished_;            // those that this one finishes, in SumOrder::node
};

}  // namespace trocar
