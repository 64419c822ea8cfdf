#include "solver/sum_order.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/check.h"
#include "base/threads.h"
#include "solver/block_ranges.h"
#include "solver/row_order.h"

namespace trocar {

namespace {

constexpr std::int32_t no_run = -1, several_runs = -2;

std::int64_t corners_of_block(const ElementBlocks& blocks) {
  return std::ssize(blocks.corner) / blocks.n_blocks;
}

// Calls body(corner) for the corners of a lane: their places in the list's arrays.
template <class Body>
void for_corners_of_lane(const ElementBlocks& blocks, std::int64_t lane, const Body& body) {
  const std::int64_t n = corners_of_block(blocks), first = lane / blocks.lanes * n;
  for (std::int64_t k = lane % blocks.lanes; k < n; k += blocks.lanes) body(first + k);
}

struct NodeUse {
  std::vector<std::int32_t> run, last_block;  // (n_local)
};

// Blocks are counted through all lists.
NodeUse use_of_nodes(const Model& model) {
  const auto n = static_cast<std::size_t>(model.n_local);
  NodeUse use{std::vector<std::int32_t>(n, no_run), std::vector<std::int32_t>(n)};
  std::int32_t block = 0, run = 0;
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t n_corners = corners_of_block(blocks);
    for (std::int64_t first = 0; first < std::ssize(blocks.corner); first += n_corners, ++block) {
      while (block >= model.sums.run_block[run + 1]) ++run;
      for (std::int64_t k = first; k < first + n_corners; ++k) {
        const std::int32_t i = blocks.corner[k];
        use.run[i] = use.run[i] == no_run || use.run[i] == run ? run : several_runs;
        use.last_block[i] = block;
      }
    }
  }
  return use;
}

// Own nodes of each run by a counting sort over their last blocks, which ascend from run to run.
void order_own_nodes(const NodeUse& use, Model& model) {
  SumOrder& sums = model.sums;
  const std::int64_t n_blocks = sums.run_block.back();
  std::vector<std::int32_t> next(static_cast<std::size_t>(n_blocks) + 1, 0);
  const auto is_own = [&](std::int32_t i) { return use.run[i] >= 0; };
  for (std::int32_t i = 0; i < model.n_owned; ++i)
    if (is_own(i)) ++next[use.last_block[i] + 1];
  for (std::int64_t block = 0; block < n_blocks; ++block) next[block + 1] += next[block];
  sums.run_first.resize(static_cast<std::size_t>(sums.n_runs) + 1);
  for (std::int32_t run = 0; run <= sums.n_runs; ++run)
    sums.run_first[run] = next[sums.run_block[run]];
  sums.node.resize(static_cast<std::size_t>(next.back()));
  sums.last_block.resize(sums.node.size());
  for (std::int32_t i = 0; i < model.n_owned; ++i) {
    if (!is_own(i)) continue;
    const std::int32_t at = next[use.last_block[i]]++;
    sums.node[at] = i;
    sums.last_block[at] = use.last_block[i];
  }
}

// A corner of a list.
struct CornerPlace {
  std::size_t list;
  std::int64_t at;
};

// Corners at shared nodes, in the order of the sums, but for those that a node meets first and in
// one run, which adds them at the node itself.
std::vector<CornerPlace> later_corners(const NodeUse& use, const Model& model) {
  const std::vector<std::int64_t>& first_block = model.sums.run_block;
  std::vector<std::int64_t> block_of_list{0};
  for (const ElementBlocks& blocks : model.blocks)
    block_of_list.push_back(block_of_list.back() + blocks.n_blocks);
  std::vector<std::int32_t> run_of_first(static_cast<std::size_t>(model.n_local), no_run);
  std::vector<CornerPlace> later;
  for_lanes_in_order(model.blocks, [&](std::size_t list, std::int64_t lane) {
    const ElementBlocks& blocks = model.blocks[list];
    const std::int64_t block = block_of_list[list] + lane / blocks.lanes;
    const auto run = static_cast<std::int32_t>(
        std::upper_bound(first_block.begin(), first_block.end(), block) - first_block.begin() - 1);
    for_corners_of_lane(blocks, lane, [&](std::int64_t at) {
      const std::int32_t i = blocks.corner[at];
      if (use.run[i] != several_runs) return;
      std::int32_t& first = run_of_first[i];
      if (first == no_run) first = run;
      if (first == run) return;
      first = several_runs;
      later.push_back({list, at});
    });
  });
  return later;
}

// A place for each corner that is added up later.
void place_shared_corners(const NodeUse& use, Model& model) {
  SumOrder& sums = model.sums;
  sums.n_places = model.n_local;
  if (sums.n_runs < 2) return;
  const std::vector<CornerPlace> later = later_corners(use, model);
  if (later.empty()) return;
  const auto node_of = [&](const CornerPlace& c) { return model.blocks[c.list].corner[c.at]; };
  std::vector<std::int32_t> next(static_cast<std::size_t>(model.n_local), 0);
  for (const CornerPlace& corner : later) ++next[node_of(corner)];
  std::int32_t place = model.n_local;
  for (std::int32_t i = 0; i < model.n_local; ++i) {
    if (use.run[i] != several_runs) continue;
    place += std::exchange(next[i], place);
    if (i >= model.n_owned) continue;
    sums.shared_node.push_back(i);
    sums.shared_end.push_back(place);
  }
  sums.n_places = place;
  for (ElementBlocks& blocks : model.blocks) blocks.target = blocks.corner;
  for (const CornerPlace& corner : later)
    model.blocks[corner.list].target[corner.at] = next[node_of(corner)]++;
}

bool are_consecutive(const std::int32_t* number) {
  for (int lane = 1; lane < row_lanes; ++lane)
    if (number[lane] != number[0] + lane) return false;
  return true;
}

bool has_node(const std::int32_t* corner, int n_corners, int lanes, std::int32_t node) {
  for (int a = 0; a < n_corners; ++a)
    if (std::find(corner + a * lanes, corner + a * lanes + row_lanes, node) !=
        corner + a * lanes + row_lanes)
      return true;
  return false;
}

// Of the lanes from `lane` on.
std::uint32_t row_of(const Model& model, const ElementBlocks& blocks, std::int64_t lane) {
  const std::int64_t block = lane / blocks.lanes, n = corners_of_block(blocks);
  const std::int64_t first = block * n + lane % blocks.lanes;
  const auto n_corners = static_cast<int>(n / blocks.lanes);
  std::vector<std::pair<std::int32_t, std::uint32_t>> start;
  for (int a = 0; a < n_corners; ++a) {
    const std::int64_t at = first + a * blocks.lanes;
    if (!are_consecutive(&blocks.corner[at]) || !are_consecutive(&targets(blocks)[at]))
      return has_node(&blocks.corner[first], n_corners, blocks.lanes, model.n_local - 1)
                 ? no_row_at_end
                 : no_row;
    start.emplace_back(targets(blocks)[at], static_cast<std::uint32_t>(a));
  }
  std::sort(start.begin(), start.end(), std::greater<>());
  std::uint32_t row = 0;
  for (std::size_t k = 0; k < start.size(); ++k) row |= start[k].second << (4 * k);
  return row;
}

void find_rows(Model& model) {
  for (ElementBlocks& blocks : model.blocks) {
    blocks.row.resize(blocks.element_local.size() / row_lanes);
    for (std::size_t k = 0; k < blocks.row.size(); ++k)
      blocks.row[k] = row_of(model, blocks, static_cast<std::int64_t>(k) * row_lanes);
  }
}

void finish(const NodeForces<double>& task, std::span<const std::int32_t> node) {
  active_kernels().nodes.force(task, node.data(), std::ssize(node));
}
void finish(const NodeForces<float>& task, std::span<const std::int32_t> node) {
  active_kernels().nodes.force_of_singles(task, node.data(), std::ssize(node));
}

// Of each of the nodes, counted through all lists.
std::vector<std::int32_t> last_blocks(std::span<const std::int32_t> nodes,
                                      std::span<const BlockPlace> places, const Model& model) {
  std::vector<std::int32_t> first{0}, last(nodes.size(), -1);
  for (const ElementBlocks& blocks : model.blocks) first.push_back(first.back() + blocks.n_blocks);
  for (const BlockPlace& place : places) {
    const ElementBlocks& blocks = model.blocks[place.list];
    const std::int64_t n = corners_of_block(blocks);
    for (std::int64_t k = place.block * n; k < (place.block + 1) * n; ++k) {
      const auto node = std::lower_bound(nodes.begin(), nodes.end(), blocks.corner[k]);
      if (node == nodes.end() || *node != blocks.corner[k]) continue;
      std::int32_t& block = last[static_cast<std::size_t>(node - nodes.begin())];
      block = std::max(block, first[place.list] + place.block);
    }
  }
  return last;
}

// Own nodes of the one run: the others keep their order.
void edit_own_nodes(std::span<const std::int32_t> nodes, std::span<const std::int32_t> last_block,
                    SumOrder& sums) {
  std::vector<std::pair<std::int32_t, std::int32_t>> changed, all;  // last block, node
  for (std::size_t k = 0; k < nodes.size(); ++k) changed.emplace_back(last_block[k], nodes[k]);
  std::sort(changed.begin(), changed.end());
  std::vector<std::uint8_t> is_changed(sums.node.size() + nodes.size(), 0);
  for (const std::int32_t i : nodes) is_changed[i] = 1;
  all.reserve(is_changed.size());
  auto next = changed.begin();
  for (std::size_t k = 0; k < sums.node.size(); ++k) {
    if (is_changed[sums.node[k]] != 0) continue;
    const std::pair own(sums.last_block[k], sums.node[k]);
    while (next != changed.end() && *next < own) all.push_back(*next++);
    all.push_back(own);
  }
  all.insert(all.end(), next, changed.end());
  sums.node.resize(all.size());
  sums.last_block.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) std::tie(sums.last_block[k], sums.node[k]) = all[k];
  sums.run_first = {0, static_cast<std::int32_t>(all.size())};
}

// Of these blocks, and of those that had the last node or have it now.
void edit_rows(std::span<const BlockPlace> places, Model& model) {
  const auto find = [&](ElementBlocks& blocks, std::size_t k) {
    blocks.row[k] = row_of(model, blocks, static_cast<std::int64_t>(k) * row_lanes);
  };
  for (ElementBlocks& blocks : model.blocks)
    for (std::size_t k = 0; k < blocks.row.size(); ++k)
      if (blocks.row[k] == no_row_at_end) find(blocks, k);
  for (const BlockPlace& place : places) {
    ElementBlocks& blocks = model.blocks[place.list];
    const auto n = static_cast<std::size_t>(blocks.lanes / row_lanes);
    for (std::size_t k = 0; k < n; ++k) find(blocks, static_cast<std::size_t>(place.block) * n + k);
  }
}

// As many as there are threads now.
void add_runs(std::int64_t n_blocks, SumOrder& sums) {
  if (n_blocks == 0) return;
  const std::int64_t first = sums.run_block.back(), n_runs = chunk_count(n_blocks);
  for (std::int64_t run = 1; run <= n_runs; ++run)
    sums.run_block.push_back(first + run * n_blocks / n_runs);
  sums.n_runs += static_cast<std::int32_t>(n_runs);
}

}  // namespace

std::vector<std::size_t> lists_in_order(const std::vector<ElementBlocks>& lists) {
  std::vector<std::size_t> order(lists.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t k) {
    return std::tuple(lists[k].region, lists[k].formulation, lists[k].reads_halo);
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

void order_sums(Model& model) {
  std::int64_t n_inside = 0;
  for (const ElementBlocks& blocks : model.blocks)
    if (!blocks.reads_halo) n_inside += blocks.n_blocks;
  SumOrder& sums = model.sums;
  sums.run_block = {0};
  add_runs(n_inside, sums);
  sums.n_inside_runs = sums.n_runs;
  add_runs(count_blocks(model) - n_inside, sums);
  const NodeUse use = use_of_nodes(model);
  order_own_nodes(use, model);
  place_shared_corners(use, model);
  find_rows(model);
}

void finish_nodes(const Model& model, std::span<const std::int32_t> node, Scratch& scratch) {
  const Vec3& g = model.options.gravity;
  with_sums(model, scratch, [&](auto& sum) {
    finish(NodeForces{.mass = model.mass.data(),
                      .gravity = {g.x(), g.y(), g.z(), 0},
                      .sum = sum.data(),
                      .force = scratch.force.data()},
           node);
  });
}

void edit_sums(std::span<const std::int32_t> nodes, std::span<const BlockPlace> blocks,
               Model& model) {
  for (ElementBlocks& list : model.blocks) list.target.clear();
  const bool is_one_run = model.sums.n_runs == 1 && model.sums.n_inside_runs == 1;
  if (is_one_run && chunk_count(count_blocks(model)) == 1) {
    edit_own_nodes(nodes, last_blocks(nodes, blocks, model), model.sums);
    model.sums.n_places = model.n_local;
    edit_rows(blocks, model);
  } else {
    model.sums = {};
    order_sums(model);
  }
}

}  // namespace trocar
