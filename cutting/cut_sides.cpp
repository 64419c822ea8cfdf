// Groups of corners by union of uncrossed edges.
#include "cutting/cut_sides.h"

#include <algorithm>
#include <cmath>

namespace trocar {

// A node nearer to the surface than this (over h) may be crossed on both sides by bands of
// different frames; it counts as on it.
static constexpr double contradiction_distance = 0.15;

namespace {

struct CrossedEdges {
  std::array<std::int8_t, 6> first_side{};  // side of the first corner; 0: not crossed
};

}  // namespace

static int group_of(const std::array<int, 4>& parent, int a) {
  while (parent[a] != a) a = parent[a];
  return a;
}

static ElementSides sides_of(const CrossedEdges& crossed, const std::array<bool, 4>& is_neutral) {
  ElementSides sides;
  if (std::ranges::all_of(crossed.first_side, [](std::int8_t s) { return s == 0; })) return sides;
  std::array<int, 4> parent{0, 1, 2, 3};
  std::array<std::int8_t, 4> group_side{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [a, b] = tet_edges[k];
    if (is_neutral[a] || is_neutral[b]) continue;
    if (crossed.first_side[k] == 0)
      parent[group_of(parent, b)] = group_of(parent, a);
    else
      sides.kind = CutKind::separated;
  }
  if (sides.kind == CutKind::uncut) return sides;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [a, b] = tet_edges[k];
    if (is_neutral[a] || is_neutral[b] || crossed.first_side[k] == 0) continue;
    for (const auto& [c, side] : {std::pair<int, int>{a, crossed.first_side[k]},
                                  std::pair<int, int>{b, -crossed.first_side[k]}}) {
      std::int8_t& known = group_side[group_of(parent, c)];
      if (known != 0 && known != side) sides.kind = CutKind::front;
      known = static_cast<std::int8_t>(side);
    }
  }
  for (std::size_t c = 0; c < 4; ++c)
    if (!is_neutral[c]) sides.corner[c] = group_side[group_of(parent, static_cast<int>(c))];
  return sides;
}

// Sides that the crossings give to each node: bit 0 for +, bit 1 for -.
static std::vector<std::uint8_t> node_votes(const CutPatch& patch,
                                            const std::vector<CrossedEdges>& crossed) {
  std::vector<std::uint8_t> votes(patch.node.size(), 0);
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (std::size_t k = 0; k < 6; ++k) {
      const int side = crossed[e].first_side[k];
      if (side == 0) continue;
      votes[patch.corner[e][tet_edges[k][0]]] |= side > 0 ? 1 : 2;
      votes[patch.corner[e][tet_edges[k][1]]] |= side > 0 ? 2 : 1;
    }
  return votes;
}

static std::vector<bool> neutral_nodes(const CutSurroundings& around, const CutStroke& stroke,
                                       const std::vector<CrossedEdges>& crossed) {
  const CutPatch& patch = around.patch;
  const std::vector<std::uint8_t> votes = node_votes(patch, crossed);
  std::vector<bool> is_neutral(patch.node.size(), false);
  for (const auto* nodes : {&stroke.surface_node, &stroke.made_node})
    for (const std::int32_t node : *nodes)
      if (const std::int32_t i = patch.local_node(node); i >= 0) is_neutral[i] = true;
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) {
    if (votes[i] != 3 || around.points.of(i).empty()) continue;
    if (std::abs(around.distance[i]) < contradiction_distance * around.h) is_neutral[i] = true;
  }
  return is_neutral;
}

std::vector<ElementSides> element_sides(const CutSurroundings& around, const CutStroke& stroke) {
  const CutPatch& patch = around.patch;
  std::vector<CrossedEdges> crossed(patch.element.size());
  const std::vector<std::span<const CutHit>> hits = hits_of(stroke, patch.element);
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (const CutHit& hit : hits[e]) crossed[e].first_side[hit.edge] = hit.is_first_plus ? 1 : -1;
  const std::vector<bool> is_neutral = neutral_nodes(around, stroke, crossed);
  std::vector<ElementSides> sides;
  sides.reserve(patch.element.size());
  for (std::int32_t e = 0; e < patch.n_elements(); ++e) {
    std::array<bool, 4> neutral{};
    for (std::size_t c = 0; c < 4; ++c) neutral[c] = is_neutral[patch.corner[e][c]];
    sides.push_back(sides_of(crossed[e], neutral));
    sides.back().is_neutral = neutral;
  }
  return sides;
}

}  // namespace trocar
