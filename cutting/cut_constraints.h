// What a cut has to leave where it is, as far as the mesh alone does not tell.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace trocar {

using BorderEdge = std::array<std::int32_t, 2>;

// Of nodes that must not be displaced: supports leave them some components.
inline constexpr std::uint8_t may_slide = 2;

struct CutConstraints {
  // (n_nodes) nodes that must not be displaced: 1, grasped or supported, or `may_slide`
  std::span<const std::uint8_t> is_held;
  // Edges of the outer surface that bound an area of it, lower node first, ascending: nodes on them
  // move along them only. Of a plane body the nodes that bound a part of its outline, each twice.
  std::span<const BorderEdge> border = {};

  // (n_nodes) Of plane cuts: where nodes are in the deformed body, in which no element may be
  // inverted, either; none: as in the reference. [m]
  std::span<const Vec3> x = {};
};

}  // namespace trocar
