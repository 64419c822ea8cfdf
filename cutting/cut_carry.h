// Where the blade's edge ended in the tissue. Tissue moves between two frames, so the next band
// must begin at the material points where the last one ended, not where they were: else strips
// between bands stay joined. A blade that tissue moves onto cuts like one that moves into tissue.
#pragma once

#include <span>

#include "base/vec.h"
#include "cutting/blade_sweep.h"
#include "cutting/cut_index.h"
#include "cutting/cut_stroke.h"
#include "mesh/mesh.h"

namespace trocar {

// Part of the mean edge by which a point of the blade that trembles has not left its place.
inline constexpr double same_place = 0.1;

// ... beyond an end of the blade's edge where tissue is looked for that it leaves joined.
inline constexpr double beyond_end = 0.05;

// Whether the edge was in the tissue or beside it when it was last remembered.
bool is_remembered(const CutStroke& stroke, const BladeSweep& sweep);

// The sweep as the tissue sees it: `before` is carried along with the tissue since the edge was
// remembered. Points far outside follow the nearest other one; while all are, the tissue's way
// within the frame is that of the sweep.
BladeSweep carry_edge(const Mesh& mesh, std::span<const Vec3> x, const BladeSweep& sweep,
                      const CutStroke& stroke);

// Takes down the material points of sweep.after and the elements that the edge is in. The sweep: as
// the tissue sees it. `near`: elements that may hold some, or points beyond its ends.
void remember_edge(const Mesh& mesh, const CutIndex& index, std::span<const Vec3> x,
                   const BladeSweep& sweep, std::span<const std::int32_t> near, CutStroke& stroke);

}  // namespace trocar
