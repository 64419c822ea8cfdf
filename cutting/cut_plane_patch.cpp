// Geometry and topology of the patch.
#include "cutting/cut_plane_patch.h"

#include <algorithm>

namespace trocar {

// Each edge once for each of its ends: by the element to its left, or, where that is none, by the
// one to its right.
template <typename Visit>
static void visit_directed_edges(const PlanePatch& patch, Visit visit) {
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      const int a = patch.corner[e][(f + 1) % 3], b = patch.corner[e][(f + 2) % 3];
      visit(a, b);
      if (patch.across[e][f] < 0) visit(b, a);
    }
}

int element_at(const PlanePatch& patch, const Vec2& p, double slack) {
  for (int e = 0; e < patch.n_elements(); ++e) {
    const auto& [a, b, c] = patch.corner[e];
    if (is_in_triangle(patch.X[a], patch.X[b], patch.X[c], p, slack)) return e;
  }
  return -1;
}

Grouped<int> all_neighbours(const PlanePatch& patch) {
  return group_items<int>(patch.node.size(),
                          [&](const auto& put) { visit_directed_edges(patch, put); });
}

PatchFacet find_edge(const PlanePatch& patch, int a, int b) {
  PatchFacet found;
  visit_star(patch, a, [&](int e, int k) {
    if (patch.corner[e][(k + 1) % 3] != b) return true;
    found = {e, (k + 2) % 3};
    return false;
  });
  return found;
}

PatchFacet opposite(const PlanePatch& patch, PatchFacet facet) {
  const int g = patch.across[facet.element][facet.facet];
  if (g < 0) return {g, -1};
  // The edge runs the other way round in g, so it ends at u, which the facet's corner precedes.
  const int v = patch.corner[facet.element][(facet.facet + 2) % 3];
  return {g, (corner_of(patch, g, v) + 2) % 3};
}

bool is_flippable(const PlanePatch& patch, PatchFacet facet) {
  const unsigned fixed = patch.opened[facet.element] | patch.chain[facet.element];
  const int g = patch.across[facet.element][facet.facet];
  return g >= 0 && (fixed >> facet.facet & 1) == 0 &&
         patch.region[facet.element] == patch.region[g];
}

double flipped_area(const PlanePatch& patch, PatchFacet facet) {
  const PatchFacet other = opposite(patch, facet);
  const std::array<int, 3>& e = patch.corner[facet.element];
  const Vec2 &w = patch.x[e[facet.facet]], &u = patch.x[e[(facet.facet + 1) % 3]],
             &v = patch.x[e[(facet.facet + 2) % 3]],
             &z = patch.x[patch.corner[other.element][other.facet]];
  const double mean = 0.5 * (triangle_area(w, u, v) + triangle_area(z, v, u));
  return std::min(triangle_area(w, u, z), triangle_area(z, v, w)) / mean;
}

static void set_bit(std::uint8_t& mask, int bit, bool value) {
  mask = static_cast<std::uint8_t>((mask & ~(1U << bit)) | (value ? 1U << bit : 0U));
}

static void exchange_masks(std::uint8_t& e, int f, std::uint8_t& g, int k) {
  const bool uz = (g >> (k + 1) % 3 & 1) != 0, vw = (e >> (f + 1) % 3 & 1) != 0;
  set_bit(e, f, uz);
  set_bit(g, k, vw);
  set_bit(e, (f + 1) % 3, false);
  set_bit(g, (k + 1) % 3, false);
}

void flip(PlanePatch& patch, PatchFacet facet) {
  const PatchFacet other = opposite(patch, facet);
  const int e = facet.element, f = facet.facet, g = other.element, k = other.facet;
  const PatchFacet uz = opposite(patch, {g, (k + 1) % 3}), vw = opposite(patch, {e, (f + 1) % 3});
  const int w = patch.corner[e][f], u = patch.corner[e][(f + 1) % 3];
  const int z = patch.corner[g][k], v = patch.corner[g][(k + 1) % 3];
  patch.corner[e][(f + 2) % 3] = z;
  patch.corner[g][(k + 2) % 3] = w;
  patch.across[e][f] = uz.element;
  patch.across[g][k] = vw.element;
  if (uz.element >= 0) patch.across[uz.element][uz.facet] = e;
  if (vw.element >= 0) patch.across[vw.element][vw.facet] = g;
  patch.across[e][(f + 1) % 3] = g;
  patch.across[g][(k + 1) % 3] = e;
  exchange_masks(patch.opened[e], f, patch.opened[g], k);
  exchange_masks(patch.chain[e], f, patch.chain[g], k);
  patch.star[u] = patch.star[w] = e;
  patch.star[v] = patch.star[z] = g;
}

}  // namespace trocar
