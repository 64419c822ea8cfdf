// What a cut has to leave where it is, as far as the mesh alone does not tell.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trocar {

using BorderEdge = std::array<std::int32_t, 2>;

struct CutConstraints {
  std::span<const std::uint8_t> is_held;  // (n_nodes) nodes that must not be displaced (supports,
                                          // grasped)
  // Edges of the outer surface that bound an area of it, lower node first, ascending: nodes on them
  // move along them only. Of a plane body the nodes that bound a part of its outline, each twice.
  std::span<const BorderEdge> border = {};

  CutConstraints(std::span<const std::uint8_t> held, std::span<const BorderEdge> lines = {})
      : is_held(held), border(lines) {}
  CutConstraints(const std::vector<std::uint8_t>& held) : is_held(held) {}
};

}  // namespace trocar
