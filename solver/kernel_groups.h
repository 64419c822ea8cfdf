// The loop over the groups of a task: as many lanes of a block as a register has.
#pragma once

#include "solver/kernels.h"
#include "solver/stash.h"

namespace trocar {

// A pack's worth of elements: constants of the material, and the stash.
template <class Pack>
struct Group {
  BlockValues<Pack> value;
  Stash<Pack> stash;
};

template <class Pack>
inline constexpr int groups_of_block = block_lanes<Pack> / pack_width<Pack>;

template <class Pack>
[[gnu::always_inline]] inline Group<Pack> group_of(const BlockTask& task, std::int64_t block,
                                                   int lane) {
  constexpr int lanes = block_lanes<Pack>;
  return {{static_cast<const RealOf<Pack>*>(task.data) + block * task.n_values * lanes + lane},
          {static_cast<RealOf<Pack>*>(task.stash) + block * task.n_stash * lanes + lane}};
}
template <class Pack>
[[gnu::always_inline]] inline Group<Pack> group_of(const BlockTask& task, std::int64_t group) {
  constexpr int groups = groups_of_block<Pack>;
  return group_of<Pack>(task, group / groups, static_cast<int>(group % groups) * pack_width<Pack>);
}

// Calls body(group, block, lane) for every group.
template <class Pack, class Body>
[[gnu::always_inline]] inline void for_groups(const BlockTask& task, const Body& body) {
  for (std::int64_t block = 0; block < task.n_blocks; ++block)
    for (int lane = 0; lane < block_lanes<Pack>; lane += pack_width<Pack>)
      body(group_of<Pack>(task, block, lane), block, lane);
}

}  // namespace trocar
