#include "solver/model_edit.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/check.h"
#include "solver/history.h"
#include "solver/model_lists.h"
#include "solver/node_layout.h"
#include "solver/sum_order.h"
#include "solver/volume_averages.h"

namespace trocar {

namespace {

// Where element k of the part is.
struct Place {
  std::size_t list;
  std::int64_t lane;
};
Place place_of(std::int32_t k, const Model& model) {
  for (std::size_t list = 0; list < model.blocks.size(); ++list) {
    if (const std::int32_t lane = lane_of(model.blocks[list], k); lane >= 0) return {list, lane};
  }
  CHECK(false);
  return {0, 0};
}

// Elements ascend, so that those of a block mostly follow each other.
std::vector<BlockPlace> blocks_of(const Part& part, std::span<const std::int32_t> elements,
                                  const Model& model) {
  std::vector<BlockPlace> blocks;
  for (const std::int32_t e : elements) {
    const std::int64_t k = part.place_of(e);
    if (k < 0) continue;
    const Place place = place_of(static_cast<std::int32_t>(k), model);
    const BlockPlace block{
        .list = place.list,
        .block = static_cast<std::int32_t>(place.lane / model.blocks[place.list].lanes)};
    if (blocks.empty() || blocks.back() != block) blocks.push_back(block);
  }
  return blocks;
}

std::vector<std::int32_t> owned_of(const Part& part, std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> owned;
  for (const std::int32_t node : nodes)
    if (const std::int32_t i = part.owned(node); i >= 0) owned.push_back(i);
  return owned;
}

// With the padding that repeats its corners.
void refill(const ModelSource& source, std::int32_t k, Model& model) {
  const Place place = place_of(k, model);
  ElementBlocks& blocks = model.blocks[place.list];
  fill_lane(source, place.lane, blocks, model.element_step);
  check_step(source, static_cast<std::size_t>(k), model);
  if (place.lane + 1 < blocks.n_elements) return;
  for (std::int64_t lane = place.lane + 1; lane < std::ssize(blocks.element_local); ++lane)
    fill_corners(source, lane, blocks);
}

void refill_corners(const ModelSource& source, const BlockPlace& place, Model& model) {
  ElementBlocks& blocks = model.blocks[place.list];
  for (std::int64_t lane = 0; lane < blocks.lanes; ++lane)
    fill_corners(source, std::int64_t{place.block} * blocks.lanes + lane, blocks);
}

// Whether none of these that the part has reads halo nodes.
bool are_inside(const ModelSource& source, std::span<const std::int32_t> elements) {
  return std::ranges::all_of(elements, [&](std::int32_t e) {
    return source.part.place_of(e) < 0 ||
           std::ranges::all_of(source.mesh.corners(e), [&](std::int32_t i) {
             return source.part.node_local[i] < source.part.n_owned;
           });
  });
}

// Elements of a list after an edit, and the lanes that they had in it; -1: new ones.
struct Lanes {
  std::vector<std::int32_t> element;  // positions in Part::element_global, ascending
  std::vector<std::int64_t> before;
};

// place_after (elements of the part before the edit): -1 where it was split; added: ascending.
Lanes lanes_after(const ElementBlocks& list, std::span<const std::int32_t> place_after,
                  std::span<const std::int32_t> added) {
  Lanes lanes;
  auto next = added.begin();
  const auto add = [&](std::int32_t element, std::int64_t before) {
    lanes.element.push_back(element);
    lanes.before.push_back(before);
  };
  for (std::int64_t lane = 0; lane < list.n_elements; ++lane) {
    const std::int32_t k = place_after[list.element_local[lane]];
    if (k < 0) continue;
    for (; next != added.end() && *next < k; ++next) add(*next, -1);
    add(k, lane);
  }
  for (; next != added.end(); ++next) add(*next, -1);
  return lanes;
}

// Numbers of a lane of an array [block][number][lane].
template <class Numbers>
std::int64_t n_of_lane(const Numbers& numbers, const ElementBlocks& list) {
  return std::ssize(numbers) / (std::int64_t{list.n_blocks} * list.lanes);
}

// Each lane from before[lane], as many at once as stay together. `to` may be `from` if no lane is
// new: then they move down.
template <class T>
void copy_lanes(const T* from, std::int64_t n, std::span<const std::int64_t> before,
                std::int64_t lanes, T* to) {
  const auto first = [&](std::int64_t lane) { return first_of_lane(lane, lanes, n); };
  std::int64_t n_together = 1;
  for (std::int64_t lane = 0; lane < std::ssize(before); lane += n_together, n_together = 1) {
    const std::int64_t source = before[lane];
    if (source < 0 || (from == to && source == lane)) continue;
    const std::int64_t most =
        std::min({lanes - lane % lanes, lanes - source % lanes, std::ssize(before) - lane});
    while (n_together < most && before[lane + n_together] == source + n_together) ++n_together;
    if (n_together == lanes) {
      std::copy_n(from + source * n, lanes * n, to + lane * n);
      continue;
    }
    for (std::int64_t k = 0; k < n; ++k)
      std::copy_n(from + first(source) + k * lanes, n_together, to + first(lane) + k * lanes);
  }
}

// Without the lanes that `before` leaves out, in place.
template <class Numbers>
void drop_lanes(std::span<const std::int64_t> before, ElementBlocks& list, Numbers& numbers) {
  const std::int64_t n = n_of_lane(numbers, list), n_lanes = std::ssize(before);
  copy_lanes(numbers.data(), n, before, list.lanes, numbers.data());
  const std::int64_t n_blocks = (n_lanes + list.lanes - 1) / list.lanes;
  numbers.resize(static_cast<std::size_t>(n_blocks * list.lanes * n));
  for (std::int64_t lane = n_lanes; lane < n_blocks * list.lanes; ++lane)
    for (std::int64_t k = 0; k < n; ++k)
      numbers[((n_blocks - 1) * n + k) * list.lanes + lane % list.lanes] = 0;
}

ElementBlocks shortened(const Lanes& lanes, ElementBlocks list) {
  drop_lanes(lanes.before, list, list.corner);
  drop_lanes(lanes.before, list, list.data);
  drop_lanes(lanes.before, list, list.data_single);
  list.n_elements = static_cast<std::int32_t>(lanes.element.size());
  list.n_blocks = (list.n_elements + list.lanes - 1) / list.lanes;
  list.element_local.resize(static_cast<std::size_t>(list.n_blocks * list.lanes));
  return list;
}

// With room for what is new.
ElementBlocks extended(const ModelSource& source, std::size_t key, const Lanes& lanes,
                       const ElementBlocks& from) {
  ElementBlocks list = empty_blocks(source, key, static_cast<std::int32_t>(lanes.element.size()));
  const auto copy = [&](const auto& before, auto& now) {
    copy_lanes(before.data(), n_of_lane(now, list), lanes.before, list.lanes, now.data());
  };
  if (from.n_elements == 0) return list;
  copy(from.corner, list.corner);
  copy(from.data, list.data);
  copy(from.data_single, list.data_single);
  return list;
}

ElementBlocks moved_list(const ModelSource& source, std::size_t key, const Lanes& lanes,
                         ElementBlocks from) {
  const bool has_new = std::ranges::find(lanes.before, -1) != lanes.before.end();
  ElementBlocks list =
      has_new ? extended(source, key, lanes, from) : shortened(lanes, std::move(from));
  const auto end =
      std::copy(lanes.element.begin(), lanes.element.end(), list.element_local.begin());
  std::fill(end, list.element_local.end(), lanes.element.back());
  for (std::int64_t lane = list.n_elements; lane < std::ssize(list.element_local); ++lane)
    fill_corners(source, lane, list);
  return list;
}

void move_lists(const ModelSource& source, std::span<const std::int32_t> place_before, Model& model,
                std::vector<double>& history) {
  std::vector<std::int32_t> place_after(model.element_step.size(), -1);
  std::map<std::size_t, std::vector<std::int32_t>> added;  // by the keys of their lists
  std::map<std::size_t, ElementBlocks> before;
  for (std::int32_t k = 0; k < source.n_elements(); ++k)
    if (place_before[k] >= 0)
      place_after[place_before[k]] = k;
    else
      added[list_key(source, source.part.element_global[k])].push_back(k);
  for (ElementBlocks& list : model.blocks) before[list_key(list)] = std::move(list);
  for (const auto& [key, elements] : added) before.try_emplace(key);
  model.blocks.clear();
  std::vector<double> moved;
  for (auto& [key, list] : before) {
    const Lanes lanes = lanes_after(list, place_after, added[key]);
    if (lanes.element.empty()) continue;
    const double* const from = history.data() + list.first_history;
    model.blocks.push_back(moved_list(source, key, lanes, std::move(list)));
    moved.resize(static_cast<std::size_t>(place_history(model.blocks)));
    const ElementBlocks& now = model.blocks.back();
    copy_lanes(from, history_width(now), lanes.before, now.lanes, moved.data() + now.first_history);
  }
  history = std::move(moved);
  move_to_places(place_before, model.element_step);
  model.n_history = place_history(model.blocks);
}

}  // namespace

void edit_model(const ModelSource& source, const ModelEdit& edit, Model& model,
                std::vector<double>& history) {
  CHECK(model.clusters.node.empty());
  const bool has_splits = !edit.place_before.empty();
  if (has_splits) move_lists(source, edit.place_before, model, history);
  // Numbers of halo nodes have moved up.
  for (const BlockPlace& place :
       has_splits ? blocks_with_halo(model, model.n_owned) : model.sums.halo_block)
    refill_corners(source, place, model);
  resize_nodes(source.part, model);
  const FixedMask plane = held_by_plane(source.mesh);
  const std::vector<std::int32_t> owned = owned_of(source.part, edit.nodes);
  for (const std::int32_t i : owned) take_node(source, i, plane, model);
  for (const std::int32_t e : edit.elements)
    if (const std::int64_t k = source.part.place_of(e); k >= 0)
      refill(source, static_cast<std::int32_t>(k), model);
  if (has_splits || !are_inside(source, edit.touching))
    order_sums(model);
  else
    edit_sums(owned, blocks_of(source.part, edit.touching, model), model);
  mark_aligned(source.mesh, source.part, model);
  take_positions(source, model);
  model.averages = {};
  link_volume_averages(source.mesh, source.materials, model);
}

}  // namespace trocar
