#include "cutting/cut_plane_smooth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar {

namespace {

constexpr double asleep_below = 1e-2;  // h: a smaller step does not wake the neighbours
constexpr double good_quality = 0.8;   // elements as good are not flipped

// The lesser quality of the two triangles that a flip would make.
double flipped_quality(const PlanePatch& patch, PatchFacet facet, PatchFacet other) {
  const std::array<int, 3>& e = patch.corner[facet.element];
  const Vec2 &w = patch.x[e[facet.facet]], &u = patch.x[e[(facet.facet + 1) % 3]],
             &v = patch.x[e[(facet.facet + 2) % 3]],
             &z = patch.x[patch.corner[other.element][other.facet]];
  return std::min(quality(w, u, z), quality(z, v, w));
}

// Asked from the other side of the facet before, with the same answer.
bool is_asked_before(const Smoothing& smoothing, int e, int g) {
  return g < e && smoothing.is_near[g] != 0 && smoothing.is_turned[e] == 0 &&
         smoothing.is_turned[g] == 0;
}

bool is_better_flipped(const PlanePatch& patch, PatchFacet facet, const Smoothing& smoothing,
                       const std::vector<std::uint8_t>& is_cut_node) {
  const int e = facet.element, g = patch.across[e][facet.facet];
  if (g < 0) return false;
  const double now = std::min(smoothing.quality[e], smoothing.quality[g]);
  if (now >= good_quality || is_asked_before(smoothing, e, g) || !is_flippable(patch, facet))
    return false;
  const PatchFacet other = opposite(patch, facet);
  const int w = patch.corner[e][facet.facet], z = patch.corner[g][other.facet];
  if (is_cut_node[w] != 0 && is_cut_node[z] != 0) return false;
  return flipped_quality(patch, facet, other) > 1.02 * std::max(now, 0.0) + 1e-3;
}

void flip_and_wake(PlanePatch& patch, PatchFacet facet, Smoothing& smoothing) {
  const int e = facet.element, g = patch.across[e][facet.facet];
  flip(patch, facet);
  for (const int turned : {e, g}) {
    smoothing.is_turned[turned] = 1;
    smoothing.quality[turned] = quality(patch, turned);
    for (const int i : patch.corner[turned]) {
      smoothing.is_awake[i] = 1;
      if (smoothing.slot[i] >= 0) smoothing.star[smoothing.slot[i]].n = 0;
    }
  }
}

}  // namespace

std::vector<Movable> movable_nodes(const PlanePatch& patch, std::span<const CutChain> chains,
                                   int rings, bool is_sliding) {
  std::vector<int> ring(patch.node.size(), -1), front;
  front.reserve(patch.node.size());
  for (const CutChain& chain : chains)
    for (const int i : chain.node) {
      ring[i] = 0;
      front.push_back(i);
    }
  for (std::size_t k = 0; k < front.size() && ring[front[k]] < rings; ++k)
    visit_star(patch, front[k], [&](int e, int) {
      for (const int j : patch.corner[e]) {
        if (ring[j] >= 0) continue;
        ring[j] = ring[front[k]] + 1;
        front.push_back(j);
      }
      return true;
    });
  std::vector<Movable> result;
  result.reserve(front.size());
  for (int i = 0; i < patch.n_nodes(); ++i) {
    if (ring[i] < 1 || patch.is_held[i] != 0 || patch.is_anchored[i] != 0) continue;
    if (patch.is_boundary[i] == 0 || (is_sliding && patch.side[i].squaredNorm() > 0))
      result.push_back({i, patch.side[i]});
  }
  return result;
}

Smoothing start_smoothing(const PlanePatch& patch, std::span<const Movable> movable) {
  Smoothing smoothing{movable, {}, {}, {}, {}, {}, {}};
  smoothing.slot.assign(patch.node.size(), -1);
  for (std::size_t k = 0; k < movable.size(); ++k)
    smoothing.slot[movable[k].node] = static_cast<int>(k);
  smoothing.star.resize(movable.size());
  smoothing.is_awake.assign(patch.node.size(), 1);
  return smoothing;
}

void area_step(PlanePatch& patch, int n_sweeps, Smoothing& smoothing) {
  std::vector<std::uint8_t>& is_awake = smoothing.is_awake;
  for (int sweep = 0; sweep < n_sweeps; ++sweep)
    for (std::size_t slot = 0; slot < smoothing.movable.size(); ++slot) {
      const Movable& m = smoothing.movable[slot];
      if (is_awake[m.node] == 0) continue;
      PlaneStar& star = smoothing.star[slot];
      if (star.n == 0) find_star(patch, m.node, star);
      is_awake[m.node] = 0;
      if (relax(patch, m.node, m.side, star) < asleep_below * patch.h) continue;
      for (int k = 0; k < star.n; ++k) is_awake[star.b[k]] = 1;
      if (patch.is_boundary[m.node] != 0)
        for (int k = 0; k < star.n; ++k) is_awake[star.c[k]] = 1;
      is_awake[m.node] = 1;
    }
}

int quality_flips(PlanePatch& patch, const std::vector<std::uint8_t>& is_cut_node,
                  Smoothing& smoothing) {
  const std::size_t n = patch.element.size();
  smoothing.quality.resize(n);
  smoothing.is_near.resize(n);
  smoothing.is_turned.assign(n, 0);
  for (int e = 0; e < patch.n_elements(); ++e) {
    const auto& [a, b, c] = patch.corner[e];
    // Of numbers that are -1 or not negative the conjunction is negative if all are.
    smoothing.is_near[e] = (smoothing.slot[a] & smoothing.slot[b] & smoothing.slot[c]) >= 0 ? 1 : 0;
    smoothing.quality[e] = quality(patch, e);
  }
  int n_flips = 0;
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3 && smoothing.is_near[e] != 0; ++f) {
      if (!is_better_flipped(patch, {e, f}, smoothing, is_cut_node)) continue;
      flip_and_wake(patch, {e, f}, smoothing);
      ++n_flips;
    }
  return n_flips;
}

StarShape star_shape(const PlanePatch& patch, int node, const Vec2& x) {
  StarShape shape{1e300, 1e300};
  visit_star(patch, node, [&](int e, int a) {
    const Vec2 &b = patch.x[patch.corner[e][(a + 1) % 3]],
               &c = patch.x[patch.corner[e][(a + 2) % 3]];
    shape.quality = std::min(shape.quality, quality(x, b, c));
    shape.area = std::min(shape.area, triangle_area(x, b, c) / patch.area[e]);
    return true;
  });
  return shape;
}

}  // namespace trocar
