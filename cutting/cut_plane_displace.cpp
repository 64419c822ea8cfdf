#include "cutting/cut_plane_displace.h"

#include <algorithm>

namespace trocar {

namespace {

constexpr int max_rounds = 40;
constexpr double least_quality = 0.03;     // of an element while nodes are still on their way
constexpr double least_moved_area = 0.02;  // of its area before the cut
constexpr double least_flipped = 1e-3;     // of the mean area of the two elements

bool is_allowed(const PlanePatch& patch, int node, const Vec2& x) {
  const StarShape now = star_shape(patch, node, patch.x[node]);
  const StarShape then = star_shape(patch, node, x);
  return then.quality >= std::min(least_quality, now.quality) &&
         then.area >= std::min(least_moved_area, now.area) && then.area > 0;
}

// True when the node is at its cut point.
bool approach(PlanePatch& patch, int node, const Vec2& target) {
  const Vec2 from = patch.x[node];
  for (double fraction = 1; fraction > 0.02; fraction *= 0.6) {
    const Vec2 x = fraction < 1 ? Vec2(from + fraction * (target - from)) : target;
    if (!is_allowed(patch, node, x)) continue;
    patch.x[node] = x;
    return fraction >= 1;
  }
  return from == target;
}

bool approach_all(PlanePatch& patch, std::span<const CutChain> chains) {
  bool is_there = true;
  for (const CutChain& chain : chains)
    for (std::size_t k = 0; k < chain.node.size(); ++k)
      if (!approach(patch, chain.node[k], position(chain.path, chain.s[k]))) is_there = false;
  return is_there;
}

bool has_three_cut_nodes(const PlanePatch& patch, int e,
                         const std::vector<std::uint8_t>& is_cut_node) {
  const auto& [a, b, c] = patch.corner[e];
  return is_cut_node[a] != 0 && is_cut_node[b] != 0 && is_cut_node[c] != 0;
}

// Flips the facet of a doomed element that leads away from the cut, if the two elements are convex.
bool flip_doomed_element(PlanePatch& patch, int e) {
  for (int f = 0; f < 3; ++f) {
    const PatchFacet facet{e, f};
    if (!is_flippable(patch, facet) || flipped_area(patch, facet) < least_flipped) continue;
    flip(patch, facet);
    return true;
  }
  return false;
}

void flip_doomed_elements(PlanePatch& patch, const std::vector<std::uint8_t>& is_cut_node) {
  for (int e = 0; e < patch.n_elements(); ++e)
    if (patch.chain[e] != 0 && has_three_cut_nodes(patch, e, is_cut_node))
      flip_doomed_element(patch, e);
}

}  // namespace

bool displace_onto_cut(PlanePatch& patch, std::span<const CutChain> chains,
                       std::span<const Movable> neighbours,
                       const std::vector<std::uint8_t>& is_cut_node) {
  for (int round = 0; round < max_rounds; ++round) {
    flip_doomed_elements(patch, is_cut_node);
    if (approach_all(patch, chains)) return true;
    Smoothing smoothing = start_smoothing(patch, neighbours);
    quality_flips(patch, is_cut_node, smoothing);
    area_step(patch, 2, smoothing);
  }
  return false;
}

}  // namespace trocar
