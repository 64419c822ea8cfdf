// Facets speak for slices, not nodes: where a blade leaves the body, single nodes near it get the
// other side in one of ten random cuts, and nothing stays joined there. Where a slice hangs on
// tissue that the stroke parts, it is parted, too, further off the blade.
#include "cutting/cut_missed_slice.h"

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "cutting/cut_slice.h"

namespace trocar {

// Over h: a blade nearer to the outer surface lies on it. Lips of a cut lie up to this far beside
// the blade that made them, all along some: it cuts nothing when it comes again.
static constexpr double on_surface = 0.05, beside_lip = 0.15;
// Over h^2, of the facets of a stretch. Where a blade comes out through the surface, one or two are
// left now and then, 0.3 to 0.4 h^2 each.
static constexpr double least_stretch_area = 1;

namespace {

// Of the outer surface, with the blade between it and the node opposite to it.
struct SliceFacet {
  std::int32_t element = 0;
  std::array<std::int32_t, 3> node{};
  double area = 0;  // [m^2]
};

// Connected facets.
struct Stretch {
  std::int32_t first = -1;         // element
  double area = 0, held_area = 0;  // [m^2]
};

}  // namespace

static bool is_held(const CutPatch& patch, std::int32_t i) {
  return patch.is_locked[i] != 0 && patch.is_bent[i] == 0;
}

static bool bounds_slice(const Mesh& mesh, const CutSurroundings& around, std::int32_t e, int f) {
  const CutPatch& patch = around.patch;
  if (patch.across[e][f] >= 0) return false;
  const bool is_lip = (mesh.cut_facets[patch.element[e]] >> f & 1) != 0;
  const double least = (is_lip ? beside_lip : on_surface) * around.h;
  const double opposite = around.distance[patch.corner[e][f]];
  return std::abs(opposite) > least &&
         std::ranges::all_of(facet_nodes(patch, e, f), [&](std::int32_t i) {
           const double thickness = opposite > 0 ? -around.distance[i] : around.distance[i];
           return thickness > least && thickness <= thinnest_slice * around.h;
         });
}

// At elements that the blade crossed and that got no side.
static std::vector<SliceFacet> slice_facets(const Mesh& mesh, const CutSurroundings& around,
                                            const CutStroke& stroke) {
  const CutPatch& patch = around.patch;
  const std::vector<std::span<const CutHit>> hits = hits_of(stroke, patch.element);
  const std::vector<const std::int8_t*> side = find_elements(stroke.side, patch.element);
  std::vector<SliceFacet> facet;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; side[e] == nullptr && !hits[e].empty() && f < 4; ++f) {
      if (!bounds_slice(mesh, around, e, f)) continue;
      const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
      facet.push_back({e, node, 0.5 * facet_normal(patch, node).norm()});
    }
  return facet;
}

std::vector<CutRefusal> missed_slices(const Mesh& mesh, const CutSurroundings& around,
                                      const CutStroke& stroke) {
  const CutPatch& patch = around.patch;
  const std::vector<SliceFacet> facet = slice_facets(mesh, around, stroke);
  DisjointSets joined(patch.node.size());
  for (const SliceFacet& f : facet)
    for (const std::int32_t i : f.node) joined.join(f.node[0], i);
  std::vector<Stretch> stretch(patch.node.size());
  for (const auto& [e, node, area] : facet) {
    Stretch& s = stretch[joined.root(node[0])];
    if (s.first < 0) s.first = e;
    s.area += area;
    if (std::ranges::all_of(node, [&](std::int32_t i) { return is_held(patch, i); }))
      s.held_area += area;
  }
  std::vector<CutRefusal> places;
  for (const auto& [first, area, held_area] : stretch) {
    if (first < 0 || area < least_stretch_area * around.h * around.h) continue;
    const Vec3& X = hits_of(stroke, patch.element[first]).front().X;
    places.push_back({X, 2 * held_area > area ? CutRefusal::slice_held : CutRefusal::slice, area});
  }
  return places;
}

}  // namespace trocar
