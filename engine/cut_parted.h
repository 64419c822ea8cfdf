// Whether a cut has parted the tissue at a place. Asked in the reference configuration, in which
// the lips of a wound lie on each other however far it gapes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace trocar {

// Whether the segment (reference positions) goes through a facet that a cut opened, at most 60
// degrees off its normal. `near`: elements around it, on one of the facet's sides at least.
bool is_parted(const Mesh& mesh, std::span<const std::int32_t> near,
               const std::array<Vec3, 2>& segment);

}  // namespace trocar
