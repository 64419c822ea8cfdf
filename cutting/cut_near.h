// Which elements a blade's band may meet, without a look at the whole mesh: a walk from the body's
// surface, where a band enters, and from where the one before it ended.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "cutting/cut_index.h"
#include "cutting/cut_positions.h"
#include "mesh/mesh.h"

namespace trocar {

// Elements that the box may meet in the present configuration, ascending: their corners are not all
// beyond one side of it, and their boxes along the axes of space overlap its own.
struct NearElements {
  std::vector<std::int32_t> tets, hexahedra;
};
// All in the body ...
NearElements near_elements(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
                           const OrientedBox& box);
// ... and those that hang together, through such elements, with the body's surface or with
// `begin`. What is cut in one piece with the surface or with one of these elements is among them.
NearElements near_elements(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
                           const OrientedBox& box, std::span<const std::int32_t> begin);

}  // namespace trocar
