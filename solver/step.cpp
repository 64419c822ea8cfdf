// Forces: each element adds its corner forces at its nodes, in the order of the elements. A thread
// takes a run of blocks and finishes the nodes that it alone meets: with hexahedra as soon as they
// are complete, while they are in its cache, without at the end of the run; the few others are
// finished afterwards (SumOrder).
#include "solver/step.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/element_watch.h"
#include "solver/history.h"
#include "solver/prefetch.h"
#include "solver/sum_order.h"
#include "solver/viscous_stress.h"

namespace trocar {

namespace {

double* history_at(const ElementBlocks& blocks, std::int64_t block, State& state) {
  return state.history.data() + blocks.first_history + block * blocks.lanes * history_width(blocks);
}

// A thread's part of a look.
struct ThreadWatch {
  ElementWatch* all = nullptr;  // null: nobody looks
  LeastOfElements least;
};

void add_list(const Model& model, const ElementBlocks& blocks, std::int64_t first, std::int64_t n,
              const Components& components, State& state, Scratch& scratch, ThreadWatch& watch,
              RunPrefetch& prefetch) {
  for_strained_blocks(model, blocks, state, components, first, n,
                      [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
                        prefetch.beside(blocks, block, task.n_blocks);
                        if (watch.all != nullptr)
                          watch.all->look(model, blocks, kernels, task, block, watch.least);
                        if (blocks.prony.empty() || scratch.is_elastic)
                          kernels.law.stress(task);
                        else
                          put_viscous_stress(blocks, kernels, task,
                                             scratch.viscous[&blocks - model.blocks.data()],
                                             history_at(blocks, block, state));
                        with_sums(model, scratch, [&](auto& sum) {
                          kernels.element.force(task, targets(blocks, block), sum.data());
                        });
                      });
}

// Calls body(begin, end) for the runs of blocks within [begin, end) that don't sleep.
template <class Body>
void for_awake_blocks(const Scratch& scratch, std::int64_t begin, std::int64_t end,
                      const Body& body) {
  if (scratch.is_asleep.empty()) return body(begin, end);
  while (begin < end) {
    std::int64_t next = begin;
    while (next < end && scratch.is_asleep[next] == 0) ++next;
    if (begin < next) body(begin, next);
    begin = next + 1;
  }
}

// Displacements by component of nodes that a run meets, taken over as far as they are asked for. A
// window that slides over the nodes stays in the cache; at its end it begins anew. What is asked
// for has not moved yet.
class RunComponents {
 public:
  RunComponents(const Model& model, std::int64_t run, Scratch& scratch) : model_(model) {
    if (!model.is_by_component) return;
    const ComponentWindow& window = model.sums.window[run];
    stride_ = (model.sums.window[run + 1].at - window.at) / 3;
    at_ = scratch.u_by_component.data() + window.at;
    slides_ = window.first_node == ComponentWindow::slides;
    if (!slides_) first_ = window.first_node;
  }

  // What the stride reads.
  void take(const State& state, std::int64_t stride) {
    if (at_ == nullptr) return;
    const auto& [own, halo] = model_.sums.stride_nodes[stride];
    if (slides_ && (own.begin < first_ || component_stride(own.end - first_) > stride_)) {
      first_ = own.begin;
      own_ = {};
    }
    extend(state, own, own_);
    extend(state, halo, halo_);
  }

  Components all() const {
    return at_ == nullptr ? Components{} : Components{at_ - first_, stride_};
  }

 private:
  const Model& model_;
  bool slides_ = true;
  std::int32_t first_ = std::numeric_limits<std::int32_t>::max();  // node at at_
  NodeRange own_, halo_;                                           // that are taken
  std::int64_t stride_ = 0;
  double* at_ = nullptr;

  // taken: one range that asked overlaps or touches, or none.
  void extend(const State& state, const NodeRange& asked, NodeRange& taken) {
    if (asked.begin == asked.end) return;
    if (taken.begin == taken.end) taken = {asked.begin, asked.begin};
    copy(state, {asked.begin, taken.begin});
    copy(state, {taken.end, asked.end});
    taken = {std::min(asked.begin, taken.begin), std::max(asked.end, taken.end)};
  }
  void copy(const State& state, const NodeRange& nodes) {
    if (nodes.begin >= nodes.end) return;
    active_kernels().nodes.split(state.u.data() + 3 * std::int64_t{nodes.begin},
                                 nodes.end - nodes.begin, at_ + (nodes.begin - first_), stride_);
  }
};

struct Strides {
  std::int32_t begin = 0, end = 0;
};

// The blocks of these strides of a run, and the nodes that then are complete.
void compute_run(const Model& model, std::int64_t run, const Strides& strides, State& state,
                 Scratch& scratch, ElementWatch* all, const NodeMotion* motion) {
  ThreadWatch watch{.all = all, .least = all != nullptr ? all->first() : LeastOfElements{}};
  const SumOrder& sums = model.sums;
  RunComponents components(model, run, scratch);
  RunPrefetch prefetch(model, run, state, scratch);
  std::int64_t block = sums.run_block[run] + stride_blocks * (strides.begin - sums.run_stride[run]);
  for (std::int32_t stride = strides.begin; stride < strides.end; ++stride) {
    const std::int64_t next = std::min(block + stride_blocks, sums.run_block[run + 1]);
    prefetch.start(stride);
    for_awake_blocks(scratch, block, next, [&](std::int64_t begin, std::int64_t end) {
      components.take(state, stride);
      for_block_range(
          model, begin, end, [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
            add_list(model, blocks, first, n, components.all(), state, scratch, watch, prefetch);
          });
    });
    finish_nodes(model,
                 {sums.node.begin() + sums.stride_first[stride],
                  sums.node.begin() + sums.stride_first[stride + 1]},
                 scratch, motion);
    block = next;
  }
  if (all != nullptr) all->take(watch.least);
}

// Slot by slot, of the nodes from `first` to `last`.
void add_slots(const Model& model, std::int32_t first, std::int32_t last, Scratch& scratch) {
  const SumOrder& sums = model.sums;
  with_sums(model, scratch, [&](auto& sum) {
    // As where one run meets a node alone.
    const FlushSubnormals flush(model.options.precision == Precision::in_single);
    for (std::int32_t slot = 0; slot < sums.n_slots; ++slot) {
      const auto slot_begin = sums.place_node.begin() + sums.slot_first[slot];
      const auto slot_end = sums.place_node.begin() + sums.slot_first[slot + 1];
      const auto begin = std::lower_bound(slot_begin, slot_end, first);
      const auto end = std::upper_bound(begin, slot_end, last);
      add_places(sum.data(), sum_stride(model), model.n_local + (begin - sums.place_node.begin()),
                 {begin, end});
    }
  });
}

void finish_shared_nodes(const Model& model, Scratch& scratch, const NodeMotion* motion) {
  const std::vector<std::int32_t>& node = model.sums.shared_node;
  if (node.empty()) return;
  parallel_for_nodes(std::ssize(node), [&](std::int64_t first, std::int64_t last) {
    if (first == last) return;
    add_slots(model, node[first], node[last - 1], scratch);
    finish_nodes(model, {node.begin() + first, node.begin() + last}, scratch, motion);
  });
}

// Nodes of other ranks have sums that nobody takes.
void clear_halo(const Model& model, Scratch& scratch) {
  const SumOrder& sums = model.sums;
  const std::int64_t of_owned = sums.slot_first.empty() ? 0 : sums.slot_first[sums.n_slots];
  with_sums(model, scratch, [&](auto& sum) {
    const auto clear = [&](std::int64_t first, std::int64_t last) {
      if (!model.is_by_component) {
        std::fill(sum.begin() + 4 * first, sum.begin() + 4 * last, 0);
        return;
      }
      for (std::int64_t j = 0; j < 3; ++j)
        std::fill(sum.begin() + j * sum_stride(model) + first,
                  sum.begin() + j * sum_stride(model) + last, 0);
    };
    clear(model.n_owned, model.n_local);
    clear(model.n_local + of_owned, sums.n_places);
  });
}

}  // namespace

void begin_force(const Model& model, State& state, Scratch& scratch, ElementWatch* watch,
                 const NodeMotion* motion) {
  CHECK_OP(std::ssize(state.u), ==, 3 * std::int64_t{model.n_local});
  CHECK_OP(std::ssize(state.theta), ==, std::int64_t{model.n_local} * model.averages.n_fields);
  CHECK_OP(std::ssize(scratch.force), ==, 3 * std::int64_t{model.n_owned});
  with_sums(model, scratch, [&](const auto& sum) { CHECK_OP(std::ssize(sum), ==, n_sums(model)); });
  CHECK_OP(std::ssize(state.history), ==, model.n_history);
  for (std::size_t k = 0; k < model.blocks.size(); ++k)
    if (!model.blocks[k].prony.empty())
      scratch.viscous[k] = viscous_step(model.blocks[k].prony, state.time - state.history_time);
  const std::int32_t n = model.sums.n_strides_before_halo;
  if (n > 0) compute_run(model, 0, {0, n}, state, scratch, watch, motion);
}

void end_force(const Model& model, State& state, Scratch& scratch, ElementWatch* watch,
               const NodeMotion* motion) {
  const SumOrder& sums = model.sums;
  parallel_for_chunks(sums.n_runs, [&](int run) {
    const Strides strides{std::max(sums.run_stride[run], sums.n_strides_before_halo),
                          sums.run_stride[run + 1]};
    if (strides.begin < strides.end)
      compute_run(model, run, strides, state, scratch, watch, motion);
  });
  finish_shared_nodes(model, scratch, motion);
  clear_halo(model, scratch);
  state.history_time = state.time;
}

void compute_force(const Model& model, State& state, Scratch& scratch) {
  begin_force(model, state, scratch);
  end_force(model, state, scratch);
}

void find_viscous_force(const Model& model, State& state, Scratch& scratch) {
  if (scratch.viscous_force.empty()) return;
  scratch.is_elastic = true;
  scratch.force.swap(scratch.viscous_force);
  compute_force(model, state, scratch);
  scratch.force.swap(scratch.viscous_force);
  scratch.is_elastic = false;
  for (std::size_t k = 0; k < scratch.force.size(); ++k)
    scratch.viscous_force[k] = scratch.force[k] - scratch.viscous_force[k];
}

std::size_t memory_bytes(const Model& model, const Scratch& scratch) {
  const auto bytes = [](const auto&... values) {
    return (... + (values.capacity() * sizeof(values[0])));
  };
  const SumOrder& sums = model.sums;
  const MassClusters& clusters = model.clusters;
  const VolumeAverages& averages = model.averages;
  std::size_t sum =
      bytes(model.mass, model.inertia, model.fixed, model.position, model.element_step) +
      bytes(sums.run_block, sums.run_stride, sums.halo_block, sums.node, sums.stride_first) +
      bytes(sums.shared_node, sums.place_node, sums.slot_first, sums.place_block) +
      bytes(sums.stride_nodes, sums.window) +
      bytes(clusters.offset, clusters.node, clusters.added, clusters.total, clusters.of_node) +
      bytes(averages.offset, averages.lane, averages.share, averages.stiffness) +
      bytes(scratch.sum, scratch.sum_single, scratch.u_by_component, scratch.volume_change) +
      bytes(scratch.force, scratch.swept, scratch.viscous_work, scratch.viscous_force) +
      bytes(scratch.middle, scratch.cluster_work, scratch.given, scratch.cluster_sums) +
      bytes(scratch.uncoupled, scratch.viscous, scratch.is_asleep);
  for (const ElementBlocks& blocks : model.blocks)
    sum += bytes(blocks.element_local, blocks.corner, blocks.target, blocks.target_block) +
           bytes(blocks.row, blocks.row_break, blocks.row_start, blocks.row_target) +
           bytes(blocks.data, blocks.data_single);
  return sum;
}

}  // namespace trocar
