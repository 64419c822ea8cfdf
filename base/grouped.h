// Items sorted into groups by counting: what belongs to each of n things, in two flat arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace trocar {

template <class Item = std::int32_t, class Offset = std::int32_t>
struct Grouped {
  std::vector<Offset> offset;  // (n_groups + 1) into item
  std::vector<Item> item;

  std::span<const Item> of(std::int64_t k) const {
    return {item.data() + offset[k], static_cast<std::size_t>(offset[k + 1] - offset[k])};
  }
};

// for_each(put) calls put(group, item) for each item, and is called twice. The items of a group
// stay in that order.
template <class Item = std::int32_t, class Offset = std::int32_t, class ForEach>
Grouped<Item, Offset> group_items(std::size_t n_groups, const ForEach& for_each) {
  Grouped<Item, Offset> groups;
  std::vector<Offset>& offset = groups.offset;
  // A place further on, so that where the next item of a group goes ends as where the group does.
  offset.assign(n_groups + 2, 0);
  for_each([&](auto group, const Item&) { ++offset[group + 2]; });
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  groups.item.resize(static_cast<std::size_t>(offset.back()));
  for_each([&](auto group, const Item& item) { groups.item[offset[group + 1]++] = item; });
  offset.pop_back();
  return groups;
}

}  // namespace trocar
