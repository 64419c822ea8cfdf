#include "bench/step_schemes.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include "base/grouped.h"
#include "bench/step_prefetch.h"
#include "bench/step_slots.h"
#include "solver/block_ranges.h"
#include "solver/sum_order.h"

namespace trocar {

namespace {

constexpr std::int64_t nodes_at_once = 256;  // of passes over the nodes, which stay in the cache
constexpr std::int32_t slots_ahead = 64;     // asked for in bodies that no cache holds
constexpr std::int64_t max_task_corners = stash_blocks * max_corners * lanes_of_block<float>;

Components components_of(const Model& model, const SchemeData& data) {
  if (!model.is_by_component) return {};
  return {data.u_x.data(), component_stride(model.n_local)};
}

// Of nodes that have moved.
void split_displacements(const Body& body, std::int64_t first, std::int64_t n, SchemeData& data) {
  if (body.model.is_by_component)
    active_kernels().nodes.split(body.state.u.data() + 3 * first, n, data.u_x.data() + first,
                                 component_stride(body.model.n_local));
}

// Calls put(run, blocks, kernels, task, block) for all blocks, with their stresses in the stash.
template <class Put>
void for_stressed_blocks(const Body& body, const SchemeData& data, bool adds_to_sums,
                         const Put& put) {
  const Model& model = body.model;
  const SumOrder& sums = model.sums;
  const Components components = components_of(model, data);
  parallel_for_chunks(sums.n_runs, [&](int run) {
    NodePrefetch prefetch(body, data, run, adds_to_sums);
    const auto compute = [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
      for_strained_blocks(
          model, blocks, body.state, components, first, n,
          [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
            prefetch.beside(blocks, block, task.n_blocks);
            kernels.law.stress(task);
            put(run, blocks, kernels, task, block);
          });
    };
    std::int32_t stride = sums.run_stride[run];
    const std::int64_t end = sums.run_block[run + 1];
    for (std::int64_t at = sums.run_block[run]; at < end; at += stride_blocks, ++stride) {
      prefetch.start(stride);
      for_block_range(model, at, std::min(at + stride_blocks, end), compute);
    }
  });
}

// Calls finish(first, n) for all nodes in pieces, after which displacements are split.
template <class Finish>
void for_node_pieces(Body& body, SchemeData& data, const Finish& finish) {
  parallel_for_nodes(body.model.n_owned, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t first = begin; first < end; first += nodes_at_once) {
      const std::int64_t n = std::min(nodes_at_once, end - first);
      finish(first, n);
      split_displacements(body, first, n, data);
    }
  });
}

void end_step(double dt, Body& body) {
  step_waiting(body.model, {}, {}, dt, body.state, body.scratch);
}

void step_by_forces(double dt, Body& body) {
  compute_force(body.model, body.state, body.scratch);
  integrate(body.model, body.scratch, {}, dt, body.state);
}

// What several runs met, slot by slot as the program's step.
void add_all_places(const Model& model, Scratch& scratch) {
  const SumOrder& sums = model.sums;
  const FlushSubnormals flush(model.options.precision == Precision::in_single);
  with_sums(model, scratch, [&](auto& sum) {
    for (std::int32_t slot = 0; slot < sums.n_slots; ++slot)
      add_places(sum.data(), sum_stride(model), model.n_local + sums.slot_first[slot],
                 {sums.place_node.begin() + sums.slot_first[slot],
                  sums.place_node.begin() + sums.slot_first[slot + 1]});
  });
}

void step_by_elements(double dt, Body& body, SchemeData& data) {
  const Model& model = body.model;
  with_sums(model, body.scratch, [&](auto& sum) {
    for_stressed_blocks(body, data, true,
                        [&](int, const ElementBlocks& blocks, const BlockKernels& kernels,
                            const BlockTask& task, std::int64_t block) {
                          kernels.element.force(task, targets(blocks, block), sum.data());
                        });
  });
  add_all_places(model, body.scratch);
  const NodeMotion motion = free_motion(model, dt, body.state);
  for_node_pieces(body, data, [&](std::int64_t first, std::int64_t n) {
    finish_nodes(model, std::span(data.node).subspan(std::size_t(first), std::size_t(n)),
                 body.scratch, &motion);
  });
  end_step(dt, body);
}

enum class SlotsBy { element, node };

// The slots, and the buffer of each run that kernels add to.
template <class Real>
struct Slots {
  SlotLoops<Real> loops = slot_loops(Real{});
  SlotsBy order;
  AlignedVector<Real> slot, buffer;
  std::vector<std::int32_t> target;  // in a buffer, [block][corner][lane]
  std::vector<std::uint32_t> row;    // no lanes stand in one

  Slots(SlotsBy by, const Body& body, const SchemeData& data)
      : order(by),
        slot(4 * data.place.size()),
        buffer(4 * std::size_t(max_task_corners * body.model.sums.n_runs)),
        target(std::size_t(max_task_corners)),
        row(std::size_t(max_task_corners / row_lanes), no_row) {
    std::iota(target.begin(), target.end(), 0);
  }
};

template <class Real>
void put_corners(Body& body, const SchemeData& data, Slots<Real>& slots) {
  for_stressed_blocks(
      body, data, false,
      [&](int run, const ElementBlocks& blocks, const BlockKernels& kernels, BlockTask task,
          std::int64_t block) {
        Real* const buffer = slots.buffer.data() + 4 * max_task_corners * run;
        task.row = slots.row.data();
        task.sum_stride = 0;
        kernels.element.force(task, slots.target.data(), buffer);
        const std::int64_t n = corners_of_block(blocks);
        const std::int64_t first =
            data.first_corner[std::size_t(&blocks - body.model.blocks.data())] + block * n;
        if (slots.order == SlotsBy::element)
          slots.loops.store(buffer, task.n_blocks * n, slots.slot.data() + 4 * first);
        else
          slots.loops.spread(buffer, data.place.data() + first, task.n_blocks * n,
                             slots.slot.data());
      });
}

void move_nodes(const NodeForces<double>& forces, const NodeMotion& motion,
                std::span<const std::int32_t> node) {
  active_kernels().nodes.step(forces, motion, node.data(), std::ssize(node));
}
void move_nodes(const NodeForces<float>& forces, const NodeMotion& motion,
                std::span<const std::int32_t> node) {
  active_kernels().nodes.step_of_singles(forces, motion, node.data(), std::ssize(node));
}

// Of n nodes, as if they were the first ones.
NodeMotion motion_from(const NodeMotion& all, std::int64_t first) {
  NodeMotion motion = all;
  motion.inertia += first;
  motion.fixed += first;
  motion.v += 3 * first;
  motion.u += 3 * first;
  return motion;
}

template <class Real>
void collect_corners(double dt, Body& body, SchemeData& data, const Slots<Real>& slots) {
  const Model& model = body.model;
  const Vec3& g = model.options.gravity;
  const NodeMotion motion = free_motion(model, dt, body.state);
  const std::int32_t ahead = body.scratch.is_beyond_cache ? slots_ahead : 0;
  for_node_pieces(body, data, [&](std::int64_t first, std::int64_t n) {
    alignas(64) std::array<Real, 4 * nodes_at_once> sum;
    const std::int32_t* const offset = data.node_offset.data() + first;
    {
      const FlushSubnormals flush(model.options.precision == Precision::in_single);
      if (slots.order == SlotsBy::element)
        slots.loops.collect(slots.slot.data(), offset, data.node_corner.data(), n, ahead,
                            sum.data());
      else
        slots.loops.add_up(slots.slot.data(), offset, n, ahead, sum.data());
    }
    move_nodes(NodeForces<Real>{.mass = model.mass.data() + first,
                                .gravity = {g.x(), g.y(), g.z(), 0},
                                .sum = sum.data(),
                                .force = nullptr},
               motion_from(motion, first), std::span(data.node).first(std::size_t(n)));
  });
  end_step(dt, body);
}

template <class Real>
void add_slot_schemes(Body& body, SchemeData& data, const std::function<void()>& prepare,
                      std::vector<StepScheme>& schemes) {
  for (const SlotsBy by : {SlotsBy::element, SlotsBy::node}) {
    const auto slots = std::make_shared<Slots<Real>>(by, body, data);
    schemes.push_back({by == SlotsBy::element ? "slots by element" : "slots by node", prepare,
                       [slots, &body, &data](double dt) {
                         put_corners(body, data, *slots);
                         collect_corners(dt, body, data, *slots);
                       }});
  }
}

void number_corners(const Model& model, SchemeData& data) {
  std::int64_t n = 0;
  for (const ElementBlocks& blocks : model.blocks) {
    data.first_corner.push_back(n);
    n += std::ssize(blocks.corner);
  }
  Grouped<> corners = group_items(std::size_t(model.n_owned), [&](const auto& put) {
    for_lanes_in_order(model.blocks, [&](std::size_t list, std::int64_t lane) {
      const ElementBlocks& blocks = model.blocks[list];
      if (lane >= blocks.n_elements) return;
      const std::int64_t of_block = corners_of_block(blocks);
      const std::int64_t first = first_of_lane(lane, blocks.lanes, of_block / blocks.lanes);
      for (std::int64_t k = first; k < first + of_block; k += blocks.lanes)
        put(blocks.corner[std::size_t(k)], static_cast<std::int32_t>(data.first_corner[list] + k));
    });
  });
  data.node_offset = std::move(corners.offset);
  data.node_corner = std::move(corners.item);
  data.place.assign(std::size_t(n), -1);
  std::int32_t next = 0;
  for (const std::int32_t corner : data.node_corner) data.place[std::size_t(corner)] = next++;
  for (std::int32_t& place : data.place)
    if (place < 0) place = next++;
  data.node_corner.resize(data.node_corner.size() + slots_ahead);
}

std::vector<std::int32_t> find_met_ends(const Model& model) {
  const SumOrder& sums = model.sums;
  std::vector<std::int32_t> met_end;
  for (std::int32_t run = 0; run < sums.n_runs; ++run) {
    std::int32_t end = 0;
    for (std::int64_t at = sums.run_block[run]; at < sums.run_block[run + 1]; at += stride_blocks) {
      for_block_range(
          model, at, std::min(at + stride_blocks, sums.run_block[run + 1]),
          [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
            const auto corner = blocks.corner.begin() + first * corners_of_block(blocks);
            end =
                std::max(end, 1 + *std::max_element(corner, corner + n * corners_of_block(blocks)));
          });
      met_end.push_back(end);
    }
  }
  return met_end;
}

}  // namespace

SchemeData make_scheme_data(const Body& body) {
  const Model& model = body.model;
  SchemeData data;
  data.node.resize(std::size_t(model.n_owned));
  std::iota(data.node.begin(), data.node.end(), 0);
  data.met_end = find_met_ends(model);
  if (model.is_by_component) data.u_x.resize(3 * std::size_t(component_stride(model.n_local)));
  number_corners(model, data);
  return data;
}

std::vector<StepScheme> step_schemes(Body& body, SchemeData& data) {
  const auto nothing = [] {};
  const std::function<void()> split = [&body, &data] {
    split_displacements(body, 0, body.model.n_owned, data);
  };
  std::vector<StepScheme> schemes = {
      {"one pass", nothing, [&body](double dt) { step_freely(body, dt); }},
      {"forces, motion", nothing, [&body](double dt) { step_by_forces(dt, body); }},
      {"elements, nodes", split, [&body, &data](double dt) { step_by_elements(dt, body, data); }}};
  if (body.model.options.precision == Precision::in_single)
    add_slot_schemes<float>(body, data, split, schemes);
  else
    add_slot_schemes<double>(body, data, split, schemes);
  return schemes;
}

}  // namespace trocar
