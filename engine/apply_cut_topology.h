// What follows from mesh and owners (rebuild_topology), after an edit that left every corner its
// owner: made anew around the edit, kept elsewhere, but for the lists of elements where some were
// split, and for local steps and what follow_model makes, which look through the whole body. A rank
// that holds none of the edited elements keeps its halo and model.
#pragma once

#include <cstdint>
#include <span>

#include "engine/simulation.h"

namespace trocar {

// Whether update_topology will do: all corners stay with their owners. mesh: before the edit;
// owners: behind it.
bool keeps_owners(const Simulation& s, const MeshEdit& edit);

struct TopologyEdit {
  std::span<const ElementSplit> splits;
  std::span<const std::int32_t> elements;  // edited ones and their parts, ascending
  std::span<const std::int32_t> nodes;     // all their corners, before and after it, ascending
};
// Collective. The result is rebuild_topology's, but for the state and the boxes of elements that
// this one forgets, and for local steps that were given up. Returns follow_local_steps'.
bool update_topology(Simulation& s, const TopologyEdit& edit);

}  // namespace trocar
