#include "solver/sum_places.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/sort_unique.h"
#include "solver/row_order.h"
#include "solver/sum_order.h"

namespace trocar {

namespace {

constexpr std::int32_t at_node = -1;

// A corner of a list that is added up later, as the node's slot-th.
struct LaterCorner {
  std::size_t list;
  std::int64_t at;
  std::int32_t slot;
};

// Looks at corners in the order of the sums and gives those slots that a node doesn't meet first
// and in one run, which adds them at the node itself.
class LaterCorners {
 public:
  std::vector<LaterCorner> corners;
  std::vector<std::int32_t> n_slots;  // (n_local)

  LaterCorners(std::span<const std::int32_t> run, const Model& model)
      : n_slots(run.size(), 0),
        model_(model),
        run_(run),
        block_of_list_(first_blocks(model)),
        run_of_first_(run.size(), no_run) {
    std::vector<std::int64_t> next_lane(model.blocks.size(), 0);
    for_lanes_in_order(model.blocks, [&](std::size_t list, std::int64_t lane) {
      if (lane < next_lane[list]) return;
      const bool is_row = stands_in_row(list, lane);
      is_row ? take_row(list, lane) : take_lane(list, lane);
      next_lane[list] = lane + (is_row ? row_lanes : 1);
    });
  }

 private:
  const Model& model_;
  std::span<const std::int32_t> run_;
  std::vector<std::int64_t> block_of_list_;
  std::vector<std::int32_t> run_of_first_;

  static std::int64_t first_corner(const ElementBlocks& blocks, std::int64_t lane) {
    return lane / blocks.lanes * corners_of_block(blocks) + lane % blocks.lanes;
  }

  // Whether nothing comes between the elements of these eight lanes, and so with their corners.
  bool stands_in_row(std::size_t list, std::int64_t lane) const {
    const ElementBlocks& blocks = model_.blocks[list];
    if (lane % row_lanes != 0 || !are_consecutive(&blocks.element_local[lane])) return false;
    const std::int64_t n = corners_of_block(blocks), first = first_corner(blocks, lane);
    for (std::int64_t k = 0; k < n; k += blocks.lanes)
      if (!are_consecutive(&blocks.corner[first + k])) return false;
    return true;
  }

  std::int32_t run_of(std::size_t list, std::int64_t lane) const {
    return trocar::run_of(block_of_list_[list] + lane / model_.blocks[list].lanes, model_.sums);
  }

  // Call once a corner.
  bool is_later(std::int32_t node, std::int32_t run) {
    if (run_[node] != several_runs) return false;
    std::int32_t& first = run_of_first_[node];
    if (first == no_run) first = run;
    if (first == run) return false;
    first = several_runs;
    return true;
  }

  void take_lane(std::size_t list, std::int64_t lane) {
    const ElementBlocks& blocks = model_.blocks[list];
    const std::int64_t n = corners_of_block(blocks), first = first_corner(blocks, lane);
    const std::int32_t run = run_of(list, lane);
    for (std::int64_t k = 0; k < n; k += blocks.lanes) {
      const std::int32_t node = blocks.corner[first + k];
      if (is_later(node, run)) corners.push_back({list, first + k, n_slots[node]++});
    }
  }

  // A corner's lanes get one slot, so that their places follow each other as their nodes do. The
  // corner that starts further ahead meets a node first.
  void take_row(std::size_t list, std::int64_t lane) {
    const ElementBlocks& blocks = model_.blocks[list];
    const std::int64_t n = corners_of_block(blocks), first = first_corner(blocks, lane);
    const std::int32_t run = run_of(list, lane);
    std::array<std::pair<std::int32_t, std::int64_t>, max_corners> start;
    const std::span of_corners(start.data(), static_cast<std::size_t>(n / blocks.lanes));
    for (std::int64_t k = 0; k < n; k += blocks.lanes)
      start[k / blocks.lanes] = {-blocks.corner[first + k], first + k};
    std::sort(of_corners.begin(), of_corners.end());
    for (const auto& [minus_node, at] : of_corners) take_corner_of_row(list, at, run);
  }

  void take_corner_of_row(std::size_t list, std::int64_t at, std::int32_t run) {
    const std::int32_t* const node = &model_.blocks[list].corner[at];
    std::int32_t slot = 0;
    const std::size_t n_before = corners.size();
    for (int lane = 0; lane < row_lanes; ++lane) {
      if (!is_later(node[lane], run)) continue;
      slot = std::max(slot, n_slots[node[lane]]);
      corners.push_back({list, at + lane, at_node});
    }
    for (std::size_t k = n_before; k < corners.size(); ++k) {
      corners[k].slot = slot;
      n_slots[model_.blocks[list].corner[corners[k].at]] = slot + 1;
    }
  }
};

// A place for each slot of these nodes (ascending), slot after slot; place[first[node] + slot].
// Returns the number of slots.
std::int32_t place_slots(std::span<const std::int32_t> nodes, const LaterCorners& later,
                         std::span<const std::int32_t> first, std::span<std::int32_t> place,
                         SumOrder& sums) {
  std::int32_t n_slots = 0;
  for (const std::int32_t i : nodes) n_slots = std::max(n_slots, later.n_slots[i]);
  for (std::int32_t slot = 0; slot < n_slots; ++slot) {
    sums.slot_first.push_back(static_cast<std::int32_t>(sums.place_node.size()));
    for (const std::int32_t i : nodes) {
      if (later.n_slots[i] <= slot) continue;
      place[first[i] + slot] = static_cast<std::int32_t>(sums.n_places++);
      sums.place_node.push_back(i);
    }
  }
  return n_slots;
}

// Of a block behind those that have some: its nodes, for a start.
void add_targets(std::int32_t block, ElementBlocks& blocks) {
  const std::int64_t n = corners_of_block(blocks);
  blocks.target_block.resize(static_cast<std::size_t>(blocks.n_blocks), -1);
  blocks.target_block[block] = static_cast<std::int32_t>(std::ssize(blocks.target) / n);
  const auto corner = blocks.corner.begin() + block * n;
  blocks.target.insert(blocks.target.end(), corner, corner + n);
}

}  // namespace

bool are_consecutive(const std::int32_t* number) {
  for (int lane = 1; lane < row_lanes; ++lane)
    if (number[lane] != number[0] + lane) return false;
  return true;
}

void place_shared_corners(std::span<const std::int32_t> run, Model& model) {
  SumOrder& sums = model.sums;
  sums.n_places = model.n_local;
  if (sums.n_runs < 2) return;
  const LaterCorners later(run, model);
  if (later.corners.empty()) return;
  std::vector<std::int32_t> first(run.size()), of_halo;
  std::int32_t n_places = 0;
  for (std::int32_t i = 0; i < model.n_local; ++i) {
    first[i] = n_places;
    n_places += later.n_slots[i];
    if (run[i] == several_runs) (i < model.n_owned ? sums.shared_node : of_halo).push_back(i);
  }
  std::vector<std::int32_t> place(static_cast<std::size_t>(n_places));
  sums.n_slots = place_slots(sums.shared_node, later, first, place, sums);
  place_slots(of_halo, later, first, place, sums);
  sums.slot_first.push_back(static_cast<std::int32_t>(sums.place_node.size()));
  const auto block_of = [&](const LaterCorner& corner) -> BlockPlace {
    const std::int64_t n = corners_of_block(model.blocks[corner.list]);
    return {corner.list, static_cast<std::int32_t>(corner.at / n)};
  };
  for (const LaterCorner& corner : later.corners)
    if (sums.place_block.empty() || sums.place_block.back() != block_of(corner))
      sums.place_block.push_back(block_of(corner));
  sort_unique(sums.place_block);
  for (const BlockPlace& block : sums.place_block)
    add_targets(block.block, model.blocks[block.list]);
  for (const LaterCorner& corner : later.corners) {
    ElementBlocks& blocks = model.blocks[corner.list];
    const std::int64_t n = corners_of_block(blocks), block = block_of(corner).block;
    blocks.target[blocks.target_block[block] * n + corner.at % n] =
        place[first[blocks.corner[corner.at]] + corner.slot];
  }
}

}  // namespace trocar
