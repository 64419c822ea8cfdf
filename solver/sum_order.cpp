#include "solver/sum_order.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/check.h"
#include "base/grouped.h"
#include "base/sort_unique.h"
#include "base/threads.h"
#include "solver/block_ranges.h"
#include "solver/node_layout.h"
#include "solver/row_order.h"
#include "solver/sum_places.h"

namespace trocar {

namespace {

struct NodeUse {
  std::vector<std::int32_t> run, finishing;  // (nodes) the stride that finishes them
};

std::int32_t together(std::int32_t run, std::int32_t other) {
  return run == no_run || run == other ? other : several_runs;
}

// Whether nodes wait for the end of their run in place of the stride that meets them last. Of
// tetrahedra and triangles a stride has few nodes, in many places: a pass over all of a run's,
// ascending, takes a step of half a million tetrahedra in 0.84 to 0.94 of the time (bench_parts
// 500000), one of hexahedra in 1.02 to 1.08.
bool do_nodes_wait(const Model& model) {
  return std::ranges::none_of(model.blocks, [](const ElementBlocks& blocks) {
    return corners_of_block(blocks) == 8 * std::int64_t{blocks.lanes};
  });
}

// Where nodes are finished that the run's `stride` meets last.
std::int32_t finishing_stride(const SumOrder& sums, bool do_wait, std::int32_t run,
                              std::int32_t stride) {
  return do_wait ? sums.run_stride[run + 1] - 1 : stride;
}

// Of all nodes. Blocks are counted through all lists.
NodeUse use_of_nodes(const Model& model) {
  const auto n = static_cast<std::size_t>(model.n_local);
  NodeUse use{std::vector<std::int32_t>(n, no_run), std::vector<std::int32_t>(n)};
  const SumOrder& sums = model.sums;
  const bool do_wait = do_nodes_wait(model);
  std::int32_t block = 0, run = 0;
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t n_corners = corners_of_block(blocks);
    for (std::int64_t first = 0; first < std::ssize(blocks.corner); first += n_corners, ++block) {
      while (block >= sums.run_block[run + 1]) ++run;
      const auto stride = finishing_stride(
          sums, do_wait, run,
          static_cast<std::int32_t>(sums.run_stride[run] +
                                    (block - sums.run_block[run]) / stride_blocks));
      for (std::int64_t k = first; k < first + n_corners; ++k) {
        const std::int32_t i = blocks.corner[k];
        use.run[i] = together(use.run[i], run);
        use.finishing[i] = stride;
      }
    }
  }
  return use;
}

// Own nodes by a counting sort over the strides that finish them.
void order_own_nodes(const NodeUse& use, Model& model) {
  SumOrder& sums = model.sums;
  Grouped<> nodes =
      group_items(static_cast<std::size_t>(sums.run_stride.back()), [&](const auto& put) {
        for (std::int32_t i = 0; i < model.n_owned; ++i)
          if (use.run[i] >= 0) put(use.finishing[i], i);
      });
  sums.stride_first = std::move(nodes.offset);
  sums.node = std::move(nodes.item);
}

bool has_node(const std::int32_t* corner, int n_corners, int lanes, std::int32_t node) {
  for (int a = 0; a < n_corners; ++a)
    if (std::find(corner + a * lanes, corner + a * lanes + row_lanes, node) !=
        corner + a * lanes + row_lanes)
      return true;
  return false;
}

// Whether corners that meet a place in different lanes come in the order of these; start: the place
// of each corner in the first lane.
bool is_order(std::uint32_t row, const std::array<std::int32_t, 8>& start) {
  for (int k = 0; k < 8; ++k)
    for (int l = k + 1; l < 8; ++l) {
      const std::int32_t ahead = start[corner_of_row(row, l)] - start[corner_of_row(row, k)];
      if (0 < ahead && ahead < row_lanes) return false;
    }
  return true;
}

// The corners by their starts, the last one first.
std::uint32_t descending(const std::array<std::int32_t, 8>& start, int n_corners) {
  std::array<std::uint32_t, 8> corner{0, 1, 2, 3, 4, 5, 6, 7};
  std::sort(corner.begin(), corner.begin() + n_corners, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(start[a], a) > std::pair(start[b], b);
  });
  std::uint32_t row = 0;
  for (int k = 0; k < n_corners; ++k) row |= corner[k] << (4 * k);
  return row;
}

// Of the lanes from `lane` on.
std::uint32_t row_of(const Model& model, const ElementBlocks& blocks, std::int64_t lane) {
  const std::int64_t block = lane / blocks.lanes, n = corners_of_block(blocks);
  const std::int64_t first = block * n + lane % blocks.lanes;
  const auto n_corners = static_cast<int>(n / blocks.lanes);
  std::array<std::int32_t, 8> start{};
  for (int a = 0; a < n_corners; ++a) {
    const std::int64_t at = first + a * blocks.lanes;
    const std::int32_t* const target = &targets(blocks, block)[at - block * n];
    if (!are_consecutive(&blocks.corner[at]) || !are_consecutive(target))
      return has_node(&blocks.corner[first], n_corners, blocks.lanes, model.n_local - 1)
                 ? no_row_at_end
                 : no_row;
    start[a] = *target;
  }
  return n_corners == 8 && is_order(box_row, start) ? box_row : descending(start, n_corners);
}

void find_rows(Model& model) {
  for (ElementBlocks& blocks : model.blocks) {
    blocks.row.resize(blocks.element_local.size() / row_lanes);
    for (std::size_t k = 0; k < blocks.row.size(); ++k)
      blocks.row[k] = row_of(model, blocks, static_cast<std::int64_t>(k) * row_lanes);
  }
}

template <class Real>
void finish(NodeForceKernel<Real> force, NodeStepKernel<Real> step, const NodeForces<Real>& task,
            const NodeMotion* motion, std::span<const std::int32_t> node) {
  if (motion == nullptr)
    force(task, node.data(), std::ssize(node));
  else
    step(task, *motion, node.data(), std::ssize(node));
}
void finish(const NodeForces<double>& task, const NodeMotion* motion,
            std::span<const std::int32_t> node) {
  finish(active_kernels().nodes.force, active_kernels().nodes.step, task, motion, node);
}
void finish(const NodeForces<float>& task, const NodeMotion* motion,
            std::span<const std::int32_t> node) {
  finish(active_kernels().nodes.force_of_singles, active_kernels().nodes.step_of_singles, task,
         motion, node);
}

// Where nodes are finished that the block meets last.
std::int32_t stride_of(std::int64_t block, const SumOrder& sums, bool do_wait) {
  const std::int32_t run = run_of(block, sums);
  const auto of_run = static_cast<std::int32_t>((block - sums.run_block[run]) / stride_blocks);
  return finishing_stride(sums, do_wait, run, sums.run_stride[run] + of_run);
}

// Of these nodes (ascending), all of whose elements are in the blocks; first: of each list.
NodeUse use_around(std::span<const std::int32_t> nodes, std::span<const BlockPlace> places,
                   std::span<const std::int64_t> first, const Model& model) {
  NodeUse use{std::vector<std::int32_t>(nodes.size(), no_run),
              std::vector<std::int32_t>(nodes.size(), -1)};
  const bool do_wait = do_nodes_wait(model);
  for (const BlockPlace& place : places) {
    const ElementBlocks& blocks = model.blocks[place.list];
    const std::int64_t n = corners_of_block(blocks), block = first[place.list] + place.block;
    const std::int32_t run = run_of(block, model.sums),
                       stride = stride_of(block, model.sums, do_wait);
    for (std::int64_t k = place.block * n; k < (place.block + 1) * n; ++k) {
      const auto node = std::lower_bound(nodes.begin(), nodes.end(), blocks.corner[k]);
      if (node == nodes.end() || *node != blocks.corner[k]) continue;
      const auto i = static_cast<std::size_t>(node - nodes.begin());
      use.run[i] = together(use.run[i], run);
      use.finishing[i] = std::max(use.finishing[i], stride);
    }
  }
  return use;
}

// Own nodes, after those of `nodes` changed from one of the `strides` to another: the rest keeps
// its order. strides: ascending.
void edit_own_nodes(std::span<const std::int32_t> nodes, std::span<const std::int32_t> finishing,
                    std::span<const std::int32_t> strides, SumOrder& sums) {
  std::vector<std::pair<std::int32_t, std::int32_t>> changed;  // stride, node
  for (std::size_t k = 0; k < nodes.size(); ++k) changed.emplace_back(finishing[k], nodes[k]);
  std::sort(changed.begin(), changed.end());
  const std::vector<std::int32_t> before = std::move(sums.node), first = sums.stride_first;
  std::vector<std::int32_t>& node = sums.node;
  node.clear();
  node.reserve(before.size() + nodes.size());
  auto next = changed.begin();
  std::int32_t done = 0, moved = 0;
  std::size_t stride = 0;  // the next whose first node is to be found
  const auto go_to = [&](std::size_t end) {
    node.insert(node.end(), before.begin() + done, before.begin() + first[end]);
    done = first[end];
    for (; stride <= end; ++stride) sums.stride_first[stride] = first[stride] + moved;
  };
  for (const std::int32_t edited : strides) {
    go_to(static_cast<std::size_t>(edited));
    std::vector<std::int32_t> own;
    std::set_difference(before.begin() + done, before.begin() + first[edited + 1], nodes.begin(),
                        nodes.end(), std::back_inserter(own));
    const std::size_t n_kept = own.size();
    for (; next != changed.end() && next->first == edited; ++next) own.push_back(next->second);
    std::inplace_merge(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(n_kept), own.end());
    node.insert(node.end(), own.begin(), own.end());
    done = first[edited + 1];
    moved = static_cast<std::int32_t>(node.size()) - done;
  }
  CHECK(next == changed.end());
  go_to(first.size() - 1);
}

// Of these blocks, and of those that have halo nodes, that had the last node or have it now.
void edit_rows(std::span<const BlockPlace> places, Model& model) {
  const auto find = [&](ElementBlocks& blocks, std::size_t k) {
    blocks.row[k] = row_of(model, blocks, static_cast<std::int64_t>(k) * row_lanes);
  };
  for (ElementBlocks& blocks : model.blocks)
    for (std::size_t k = 0; k < blocks.row.size(); ++k)
      if (blocks.row[k] == no_row_at_end) find(blocks, k);
  for (const std::span of : {places, std::span<const BlockPlace>(model.sums.halo_block)})
    for (const BlockPlace& place : of) {
      ElementBlocks& blocks = model.blocks[place.list];
      const auto n = static_cast<std::size_t>(blocks.lanes / row_lanes);
      for (std::size_t k = 0; k < n; ++k)
        find(blocks, static_cast<std::size_t>(place.block) * n + k);
    }
}

// Runs and their strides alone: as many as there are threads now.
SumOrder make_runs(const Model& model) {
  SumOrder sums;
  const std::int64_t n_blocks = count_blocks(model);
  sums.n_runs = n_blocks == 0 ? 0 : chunk_count(n_blocks);
  for (std::int64_t run = 0; run <= sums.n_runs; ++run)
    sums.run_block.push_back(n_blocks == 0 ? 0 : run * n_blocks / sums.n_runs);
  sums.run_stride = {0};
  for (std::int32_t run = 0; run < sums.n_runs; ++run) {
    const std::int64_t n = sums.run_block[run + 1] - sums.run_block[run];
    sums.run_stride.push_back(sums.run_stride.back() +
                              static_cast<std::int32_t>((n + stride_blocks - 1) / stride_blocks));
  }
  return sums;
}

// Of one run; several wait for all halo nodes.
std::int32_t strides_before_halo(const Model& model) {
  const SumOrder& sums = model.sums;
  if (sums.n_runs != 1) return 0;
  if (sums.halo_block.empty()) return sums.run_stride.back();
  const BlockPlace& first = sums.halo_block.front();
  return static_cast<std::int32_t>((first_blocks(model)[first.list] + first.block) / stride_blocks);
}

// After nodes were added behind the owned ones: halo nodes and places have moved up.
void move_places_up(Model& model) {
  SumOrder& sums = model.sums;
  const std::int64_t n_before = sums.n_places - std::ssize(sums.place_node);
  const auto n_added = static_cast<std::int32_t>(model.n_local - n_before);
  sums.n_places += n_added;
  for (std::int32_t& node : sums.place_node)
    if (node >= model.n_owned - n_added) node += n_added;
  for (const BlockPlace& place : sums.place_block) {
    ElementBlocks& list = model.blocks[place.list];
    const std::int64_t n = corners_of_block(list), at = list.target_block[place.block] * n;
    for (std::int64_t k = 0; k < n; ++k) {
      std::int32_t& target = list.target[at + k];
      target = target >= n_before ? target + n_added : list.corner[place.block * n + k];
    }
  }
}

// Around an edit that no other run meets; false if one does.
bool edit_around(std::span<const std::int32_t> nodes, std::span<const BlockPlace> blocks,
                 Model& model) {
  SumOrder& sums = model.sums;
  const SumOrder runs = make_runs(model);
  if (runs.run_block != sums.run_block || (model.is_by_component && runs.n_runs > 1)) return false;
  const std::vector<std::int64_t> first = first_blocks(model);
  const NodeUse use = use_around(nodes, blocks, first, model);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (use.run[k] == several_runs || std::ranges::binary_search(sums.shared_node, nodes[k]))
      return false;
  const bool do_wait = do_nodes_wait(model);
  std::vector<std::int32_t> strides;
  for (const BlockPlace& place : blocks)
    strides.push_back(stride_of(first[place.list] + place.block, sums, do_wait));
  sort_unique(strides);
  edit_own_nodes(nodes, use.finishing, strides, sums);
  move_places_up(model);
  edit_rows(blocks, model);
  lay_out_nodes(model);
  return true;
}

}  // namespace

std::vector<BlockPlace> blocks_with_halo(const Model& model, std::int32_t n_owned) {
  std::vector<BlockPlace> places;
  for (std::size_t list = 0; list < model.blocks.size() && model.n_local > n_owned; ++list) {
    const ElementBlocks& blocks = model.blocks[list];
    const std::int64_t n = corners_of_block(blocks);
    for (std::int32_t block = 0; block < blocks.n_blocks; ++block) {
      const auto corner = blocks.corner.begin() + block * n;
      if (std::any_of(corner, corner + n, [&](std::int32_t i) { return i >= n_owned; }))
        places.push_back({list, block});
    }
  }
  return places;
}

void order_sums(Model& model) {
  for (ElementBlocks& blocks : model.blocks) {
    blocks.target.clear();
    blocks.target_block.clear();
  }
  model.sums = make_runs(model);
  model.sums.halo_block = blocks_with_halo(model, model.n_owned);
  model.sums.n_strides_before_halo = strides_before_halo(model);
  const NodeUse use = use_of_nodes(model);
  order_own_nodes(use, model);
  place_shared_corners(use.run, model);
  find_rows(model);
  lay_out_nodes(model);
}

std::vector<std::int64_t> first_blocks(const Model& model) {
  std::vector<std::int64_t> first{0};
  for (const ElementBlocks& list : model.blocks) first.push_back(first.back() + list.n_blocks);
  return first;
}

std::int32_t run_of(std::int64_t block, const SumOrder& sums) {
  const auto& first = sums.run_block;
  return static_cast<std::int32_t>(std::upper_bound(first.begin(), first.end(), block) -
                                   first.begin() - 1);
}

void finish_nodes(const Model& model, std::span<const std::int32_t> node, Scratch& scratch,
                  const NodeMotion* motion) {
  const Vec3& g = model.options.gravity;
  with_sums(model, scratch, [&](auto& sum) {
    finish(NodeForces{.mass = model.mass.data(),
                      .gravity = {g.x(), g.y(), g.z(), 0},
                      .sum = sum.data(),
                      .force = scratch.force.data(),
                      .sum_stride = sum_stride(model)},
           motion, node);
  });
}

void add_places(double* sum, std::int64_t stride, std::int64_t place,
                std::span<const std::int32_t> node) {
  active_kernels().nodes.add_places(sum, stride, place, node.data(), std::ssize(node));
}
void add_places(float* sum, std::int64_t stride, std::int64_t place,
                std::span<const std::int32_t> node) {
  active_kernels().nodes.add_places_of_singles(sum, stride, place, node.data(), std::ssize(node));
}

void edit_sums(std::span<const std::int32_t> nodes, std::span<const BlockPlace> blocks,
               Model& model) {
  if (!edit_around(nodes, blocks, model)) order_sums(model);
}

}  // namespace trocar
