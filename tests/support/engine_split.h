// The plate of scene_plate.h, cut at once.
#pragma once

#include <functional>

#include "engine/apply_cut.h"
#include "scene_plate.h"

namespace trocar {

// What the plate's blade does to it at once: it puts nodes on edges, and then parts it, or does
// not.
struct PlateSplit {
  MeshEdit split;  // the first edit; others follow
  std::int64_t n_inserted = 0;
  CutRecord record;
};
using ApplyEdit = std::function<void(GlobalState&, const MeshEdit&, CutRecord&)>;
PlateSplit split_plate(Simulation& s, bool parts = true, const ApplyEdit& apply = {});

}  // namespace trocar
