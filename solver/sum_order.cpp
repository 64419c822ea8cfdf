#include "solver/sum_order.h"

#include <algorithm>
#include <functional>
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

// Calls body(run, block counted through all lists, list, place in its corners) for all corners, in
// the order in which one thread would meet them: element after element.
template <class List, class Body>
void for_corners(std::vector<List>& lists, std::int64_t n_blocks, std::int64_t n_runs,
                 const Body& body) {
  std::int64_t block = 0, run = 0;
  for (List& blocks : lists) {
    const std::int64_t n = corners_of_block(blocks);
    for (std::int64_t first = 0; first < std::ssize(blocks.corner); first += n, ++block) {
      while (block >= first_block_of_run(run + 1, n_runs, n_blocks)) ++run;
      for (std::int64_t lane = 0; lane < blocks.lanes; ++lane)
        for (std::int64_t k = lane; k < n; k += blocks.lanes)
          body(static_cast<std::int32_t>(run), static_cast<std::int32_t>(block), blocks, first + k);
    }
  }
}

struct NodeUse {
  std::vector<std::int32_t> run, last_block, n_corners;  // (n_local)
};

NodeUse use_of_nodes(Model& model, std::int64_t n_blocks) {
  const auto n = static_cast<std::size_t>(model.n_local);
  NodeUse use{std::vector<std::int32_t>(n, no_run), std::vector<std::int32_t>(n),
              std::vector<std::int32_t>(n)};
  for_corners(
      model.blocks, n_blocks, model.sums.n_runs,
      [&](std::int32_t run, std::int32_t block, const ElementBlocks& blocks, std::int64_t at) {
        const std::int32_t i = blocks.corner[at];
        use.run[i] = use.run[i] == no_run || use.run[i] == run ? run : several_runs;
        use.last_block[i] = block;
        ++use.n_corners[i];
      });
  return use;
}

// Own nodes of each run by a counting sort over their last blocks, which ascend from run to run.
void order_own_nodes(const NodeUse& use, std::int64_t n_blocks, Model& model) {
  SumOrder& sums = model.sums;
  std::vector<std::int32_t> next(static_cast<std::size_t>(n_blocks) + 1, 0);
  const auto is_own = [&](std::int32_t i) { return use.run[i] >= 0; };
  for (std::int32_t i = 0; i < model.n_owned; ++i)
    if (is_own(i)) ++next[use.last_block[i] + 1];
  for (std::int64_t block = 0; block < n_blocks; ++block) next[block + 1] += next[block];
  sums.run_first.resize(static_cast<std::size_t>(sums.n_runs) + 1);
  for (std::int32_t run = 0; run <= sums.n_runs; ++run)
    sums.run_first[run] = next[first_block_of_run(run, sums.n_runs, n_blocks)];
  sums.node.resize(static_cast<std::size_t>(next.back()));
  sums.last_block.resize(sums.node.size());
  for (std::int32_t i = 0; i < model.n_owned; ++i) {
    if (!is_own(i)) continue;
    const std::int32_t at = next[use.last_block[i]]++;
    sums.node[at] = i;
    sums.last_block[at] = use.last_block[i];
  }
}

// A place for each corner at a shared node; those of owned nodes are added up later.
void place_shared_corners(const NodeUse& use, std::int64_t n_blocks, Model& model) {
  SumOrder& sums = model.sums;
  std::vector<std::int32_t> next(static_cast<std::size_t>(model.n_local), 0);
  std::int32_t place = model.n_local;
  for (std::int32_t i = 0; i < model.n_local; ++i) {
    if (use.run[i] != several_runs) continue;
    next[i] = place;
    place += use.n_corners[i];
    if (i >= model.n_owned) continue;
    sums.shared_node.push_back(i);
    sums.shared_end.push_back(place);
  }
  sums.n_places = place;
  if (place == model.n_local) return;
  for (ElementBlocks& blocks : model.blocks) blocks.target = blocks.corner;
  for_corners(model.blocks, n_blocks, sums.n_runs,
              [&](std::int32_t, std::int32_t, ElementBlocks& blocks, std::int64_t at) {
                const std::int32_t i = blocks.corner[at];
                if (use.run[i] == several_runs) blocks.target[at] = next[i]++;
              });
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

}  // namespace

void order_sums(Model& model) {
  const std::int64_t n_blocks = count_blocks(model);
  CHECK_OP(n_blocks, >, 0);
  model.sums.n_runs = chunk_count(n_blocks);
  const NodeUse use = use_of_nodes(model, n_blocks);
  order_own_nodes(use, n_blocks, model);
  place_shared_corners(use, n_blocks, model);
  find_rows(model);
}

}  // namespace trocar
