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

// Calls body(group, block, lane) for every group.
template <class Pack, class Body>
[[gnu::always_inline]] inline void for_groups(const BlockTask& task, const Body& body) {
  constexpr int lanes = block_lanes<Pack>;
  for (std::int64_t block = 0; block < task.n_blocks; ++block)
    for (int lane = 0; lane < lanes; lane += pack_width<Pack>)
      body(
          Group<Pack>{
              {static_cast<const RealOf<Pack>*>(task.data) + block * task.n_values * lanes + lane},
              {static_cast<RealOf<Pack>*>(task.stash) + block * task.n_stash * lanes + lane}},
          block, lane);
}

}  // namespace trocar
