// Topology alone: what is open all along its edges parts the tissue, however it got there.
#include "cutting/cut_missed.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/segment.h"
#include "cutting/cut_boundary.h"
#include "cutting/cut_missed_slice.h"
#include "cutting/cut_slice.h"

namespace trocar {

namespace {

// The mesh as it will be after the edit.
struct After {
  const Mesh& mesh;
  const TetCut& cut;

  // Of a tetrahedron.
  std::array<std::int32_t, 4> corners(std::int32_t e) const {
    const CutPatch& patch = cut.around.patch;
    std::array<std::int32_t, 4> node = tet_nodes(mesh, e);
    if (const std::int32_t local = patch.local_element(e); local >= 0)
      for (std::size_t k = 0; k < 4; ++k)
        if (const std::int32_t i = cut.opening.corner[local][k]; i >= patch.n_nodes())
          node[k] = mesh.n_nodes() + i - patch.n_nodes();
    return node;
  }
  Vec3 X(std::int32_t i) const {
    const CutPatch& patch = cut.around.patch;
    if (i >= mesh.n_nodes())
      return cut.X[cut.opening.duplication.duplicate_parent[i - mesh.n_nodes()]];
    const std::int32_t local = patch.local_node(i);
    return local >= 0 ? cut.X[local] : mesh.X[i];
  }
};

struct SidedFacet {
  std::array<std::int32_t, 3> node;  // ascending
  std::int8_t side;
};

// An edge of an opened facet and its node opposite to it.
struct LipEdge {
  std::array<std::int32_t, 2> node;  // ascending
  std::int32_t opposite;
};

// Its nodes, ascending.
using RimEdge = std::array<std::int32_t, 2>;

}  // namespace

static std::array<std::int32_t, 3> nodes_of(const std::array<std::int32_t, 4>& corner, int f) {
  const std::array<int, 3>& k = tet_facets[f];
  return {corner[k[0]], corner[k[1]], corner[k[2]]};
}

// Of a blade that is still in its stroke, and looks there itself at its end.
static bool is_of_another(const CutStroke& stroke, std::int32_t e) {
  return std::ranges::binary_search(stroke.taken, e);
}

// Whether both ends of a crossed edge of element e are too far from the surface to lie beside it.
static bool is_crossed_clearly(const CutSurroundings& around, std::int32_t e,
                               std::span<const CutHit> hits) {
  return std::ranges::any_of(hits, [&](const CutHit& hit) {
    return std::ranges::all_of(tet_edges[hit.edge], [&](int c) {
      const std::int32_t i = around.patch.corner[e][c];
      return std::abs(around.distance[i]) > thinnest_slice * around.h;
    });
  });
}

// Elements without a side that the blade crossed.
static void add_unparted(const TetCut& cut, const CutStroke& stroke,
                         std::vector<CutRefusal>& places) {
  const CutPatch& patch = cut.around.patch;
  const std::vector<std::span<const CutHit>> hits = hits_of(stroke, patch.element);
  const std::vector<const std::int8_t*> side = find_elements(stroke.side, patch.element);
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    if (side[e] == nullptr && !is_of_another(stroke, patch.element[e]) &&
        is_crossed_clearly(cut.around, e, hits[e]))
      places.push_back({centre_of(patch, {&e, 1}), CutRefusal::missed});
}

static void add_joined_facets(const After& after, const CutStroke& stroke,
                              std::vector<CutRefusal>& places) {
  std::vector<SidedFacet> facet;
  facet.reserve(4 * stroke.side.size());
  for (const auto& [e, side] : stroke.side) {
    if (is_of_another(stroke, e)) continue;
    const std::array<std::int32_t, 4> corner = after.corners(e);
    for (int f = 0; f < 4; ++f) {
      facet.push_back({nodes_of(corner, f), side});
      std::ranges::sort(facet.back().node);
    }
  }
  std::ranges::sort(facet, {}, [](const SidedFacet& f) { return std::pair{f.node, f.side}; });
  for (std::size_t k = 1; k < facet.size(); ++k) {
    const auto& [node, side] = facet[k];
    if (node != facet[k - 1].node || side == facet[k - 1].side) continue;
    const Vec3 sum = after.X(node[0]) + after.X(node[1]) + after.X(node[2]);
    places.push_back({sum / 3, CutRefusal::missed});
  }
}

// Both lips of an opened facet are triangles with the same corners in space; where they share an
// edge, the opening ends.
static std::vector<RimEdge> rim_edges(const After& after, const CutStroke& stroke) {
  std::vector<LipEdge> edge;
  for (const auto& [e, mask] : stroke.opened) {
    if (is_of_another(stroke, e)) continue;
    const std::array<std::int32_t, 4> corner = after.corners(e);
    for (int f = 0; f < 4; ++f) {
      if ((mask >> f & 1) == 0) continue;
      const std::array<std::int32_t, 3> node = nodes_of(corner, f);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = node[k], b = node[(k + 1) % 3];
        edge.push_back({{std::min(a, b), std::max(a, b)}, node[(k + 2) % 3]});
      }
    }
  }
  std::ranges::sort(edge, {}, [](const LipEdge& l) { return std::pair{l.node, l.opposite}; });
  std::vector<RimEdge> rim;
  for (std::size_t k = 1; k < edge.size(); ++k) {
    const auto& [node, opposite] = edge[k];
    if (node != edge[k - 1].node || opposite == edge[k - 1].opposite) continue;
    if (after.X(opposite) == after.X(edge[k - 1].opposite)) rim.push_back(node);
  }
  return rim;
}

static Vec3 middle_of(const After& after, std::span<const std::int32_t> node) {
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t i : node) sum += after.X(i);
  return sum / static_cast<double>(node.size());
}

static void add_rims(const After& after, std::span<const RimEdge> rim,
                     std::vector<CutRefusal>& places) {
  for (const RimEdge& node : rim) places.push_back({middle_of(after, node), CutRefusal::missed});
}

// Nodes of the rim that hang together with `first`, ascending; more than `most` if they are so
// many.
static std::vector<std::int32_t> nodes_with(std::int32_t first, std::span<const RimEdge> rim,
                                            std::size_t most) {
  std::vector<std::int32_t> node = {first};
  for (std::size_t k = 0; k < node.size() && node.size() <= most; ++k)
    for (const RimEdge& edge : rim)
      for (const std::size_t end : {0, 1})
        if (edge[end] == node[k] && std::ranges::find(node, edge[1 - end]) == node.end())
          node.push_back(edge[1 - end]);
  std::ranges::sort(node);
  return node;
}

static std::size_t count_opened(const CutStroke& stroke) {
  std::size_t n = 0;
  for (const auto& [e, mask] : stroke.opened)
    n += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(mask)));
  return n / 2;
}

// Whether X lies where the stroke ends in the tissue, or where the blade has stopped and not parted
// yet what it crossed.
static bool is_at_end(const CutStroke& stroke, const Vec3& X) {
  // Mean edges; elements that hold the rim are longer than one.
  constexpr double front = 2, wider_rim = 1.5;
  if (has_come_out(stroke)) return !is_clear_of_rim(stroke, X, wider_rim);
  const double reach = front * stroke.mean_edge;
  const auto is_near = [&](const BladePoint& a, const BladePoint& b) {
    return (a.is_inside || b.is_inside) && (nearest_on_segment(a.X, b.X, X) - X).norm() < reach;
  };
  return !is_clear_of_rim(stroke, X, wider_rim) ||
         std::ranges::adjacent_find(stroke.edge, is_near) != stroke.edge.end();
}

// Of a blade that has not drawn back.
static std::vector<CutRefusal> places_on_way(const After& after, const CutStroke& stroke,
                                             std::span<const RimEdge> rim) {
  const auto& [mesh, cut] = after;
  std::vector<CutRefusal> places;
  for (const std::int32_t e : stroke.whole)
    places.push_back({element_centre(mesh, e), CutRefusal::bent});
  add_unparted(cut, stroke, places);
  add_joined_facets(after, stroke, places);
  add_rims(after, rim, places);
  if (has_come_out(stroke)) {
    const std::vector<CutRefusal> slices = missed_slices(mesh, cut.around, stroke);
    places.insert(places.end(), slices.begin(), slices.end());
  }
  std::erase_if(places, [&](const CutRefusal& place) { return is_at_end(stroke, place.X); });
  return places;
}

// Where a short rim runs into itself, and there is no other, the blade has gone around a neck,
// which may be an element wide. A longer one is the front of a cut around what it has not
// undermined yet, beside others it is a hole behind the front, and around few opened facets the
// outline of a slit inside.
static std::vector<CutRefusal> necks(const After& after, const CutStroke& stroke,
                                     std::span<const RimEdge> rim,
                                     std::span<const CutRefusal> told) {
  constexpr std::size_t longest = 12;  // edges
  const std::size_t n_opened = count_opened(stroke);
  const auto is_told = [&](const RimEdge& edge) {
    const Vec3 X = middle_of(after, edge);
    return std::ranges::any_of(told, [&](const CutRefusal& place) { return place.X == X; });
  };
  const auto is_twice = [&](std::int32_t i) {
    return std::ranges::count_if(rim, [&](const RimEdge& e) { return e[0] == i || e[1] == i; }) ==
           2;
  };
  std::vector<CutRefusal> places;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    if (k > 0 && rim[k][0] == rim[k - 1][0]) continue;
    const std::vector<std::int32_t> node = nodes_with(rim[k][0], rim, longest);
    const bool is_outline = 2 * n_opened <= node.size() * node.size();
    if (node.size() > longest || is_outline || !std::ranges::all_of(node, is_twice)) return {};
    if (node.front() == rim[k][0] && !is_told(rim[k]))
      places.push_back({middle_of(after, node), CutRefusal::neck});
  }
  return places;
}

std::vector<CutRefusal> missed_places(const Mesh& mesh, const TetCut& cut,
                                      const CutStroke& stroke) {
  const After after{mesh, cut};
  const std::vector<RimEdge> rim = rim_edges(after, stroke);
  std::vector<CutRefusal> places;
  if (!has_drawn_back(stroke)) places = places_on_way(after, stroke, rim);
  const std::vector<CutRefusal> found = necks(after, stroke, rim, places);
  places.insert(places.end(), found.begin(), found.end());
  return places;
}

}  // namespace trocar
