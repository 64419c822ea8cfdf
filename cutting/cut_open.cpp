// Partner nodes for facets between the sides, checked by the links of the nodes.
#include "cutting/cut_open.h"

#include <algorithm>

#include "base/sort_unique.h"

namespace trocar {

using Corners = std::vector<std::array<std::int32_t, 4>>;
using EdgeEnds = std::array<std::int32_t, 2>;

// A node of the front this near to the surface (over h) may be parted.
static constexpr double ripe_distance = 0.1;

static void add_edges(const std::array<std::int32_t, 3>& node, std::vector<EdgeEnds>& edge) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t a = node[k], b = node[(k + 1) % 3];
    edge.push_back({std::min(a, b), std::max(a, b)});
  }
}

static std::vector<EdgeEnds> outer_edges(const CutPatch& patch) {
  std::vector<EdgeEnds> edge;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 4; ++f)
      if (patch.across[e][f] < 0) add_edges(facet_nodes(patch, e, f), edge);
  std::sort(edge.begin(), edge.end());
  return edge;
}

PatchMesh make_patch_mesh(const CutPatch& patch) {
  PatchMesh p;
  const std::size_t n = patch.element.size();
  p.mesh.X = patch.X;
  p.mesh.element_type.assign(n, ElementType::tet4);
  p.mesh.cut_facets.assign(n, 0);
  p.mesh.corner_node.reserve(4 * n);
  p.across.neighbour.reserve(4 * n);
  p.across.offset.resize(n + 1);
  for (std::size_t e = 0; e <= n; ++e) p.across.offset[e] = static_cast<std::int32_t>(4 * e);
  p.mesh.corner_offset.assign(p.across.offset.begin(), p.across.offset.end() - 1);
  for (const auto& corner : patch.corner)
    p.mesh.corner_node.insert(p.mesh.corner_node.end(), corner.begin(), corner.end());
  for (const auto& across : patch.across)
    p.across.neighbour.insert(p.across.neighbour.end(), across.begin(), across.end());
  p.around = patch.stars;
  return p;
}

bool is_joined(const CutPatch& patch, const Corners& corner, std::int32_t e, int f) {
  const std::int32_t u = patch.across[e][f];
  if (u < 0) return false;
  for (const int c : tet_facets[f]) {
    const auto& old = patch.corner[u];
    const auto at = std::find(old.begin(), old.end(), patch.corner[e][c]) - old.begin();
    if (corner[u][at] != corner[e][c]) return false;
  }
  return true;
}

// Facets (lower element's side) between elements of different sides; in `refused` those that stay
// joined because of a bent hexahedron, or for now.
static std::vector<TetFacet> facets_between_sides(const CutPatch& patch, const CutLabels& labels,
                                                  std::vector<TetFacet>& refused) {
  std::vector<TetFacet> facet;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 4; ++f) {
      const std::int32_t u = patch.across[e][f];
      if (u < e || labels.side[e] * labels.side[u] != -1) continue;
      if (labels.kind[e] == CutKind::front || labels.kind[u] == CutKind::front) continue;
      const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
      const bool is_free = std::all_of(node.begin(), node.end(), [&](std::int32_t i) {
        return patch.is_whole(i) && patch.is_joined[i] == 0;
      });
      const auto stays = [&](std::int32_t i) {
        return patch.is_bent[i] != 0 || labels.is_left[i] != 0;
      };
      if (is_free) (std::ranges::any_of(node, stays) ? refused : facet).push_back({e, f});
    }
  return facet;
}

static void split_nodes(const CutPatch& patch, const PatchMesh& mesh,
                        const std::vector<TetFacet>& lower, CutOpening& opening) {
  opening.facet = lower;
  std::vector<std::int32_t> nodes;
  for (const auto& [e, f] : lower) {
    const std::int32_t u = patch.across[e][f];
    opening.facet.push_back({u, facet_towards(patch, u, e)});
    for (const std::int32_t i : facet_nodes(patch, e, f)) nodes.push_back(i);
  }
  std::sort(opening.facet.begin(), opening.facet.end());
  opening.duplication = duplicate_nodes(mesh.mesh, opening.facet, nodes, mesh.around, mesh.across);
  opening.corner = patch.corner;
  for (const CornerChange& change : opening.duplication.corners)
    opening.corner[change.element][change.corner] = change.node;
}

// The boundary facets at node `copy`, as directed edges of its link.
static std::vector<EdgeEnds> link_boundary(const CutPatch& patch, const Corners& corner,
                                           std::span<const std::int32_t> star, std::int32_t copy) {
  std::vector<EdgeEnds> edge;
  for (const std::int32_t e : star) {
    const auto at = std::find(corner[e].begin(), corner[e].end(), copy) - corner[e].begin();
    if (at == 4) continue;
    for (int f = 0; f < 4; ++f) {
      if (f == at || is_joined(patch, corner, e, f)) continue;
      std::array<int, 3> c = tet_facets[f];
      std::rotate(c.begin(), std::find(c.begin(), c.end(), static_cast<int>(at)), c.end());
      edge.push_back({corner[e][c[1]], corner[e][c[2]]});
    }
  }
  return edge;
}

// One closed cycle, or nothing at all inside the body.
static bool is_one_cycle(std::vector<EdgeEnds> edge) {
  if (edge.empty()) return true;
  std::sort(edge.begin(), edge.end());
  for (std::size_t k = 0; k + 1 < edge.size(); ++k)
    if (edge[k][0] == edge[k + 1][0]) return false;
  std::size_t n_visited = 0;
  std::int32_t at = edge[0][0];
  do {
    const auto next = std::lower_bound(edge.begin(), edge.end(), EdgeEnds{at, -1});
    if (next == edge.end() || (*next)[0] != at) return false;
    at = (*next)[1];
  } while (++n_visited <= edge.size() && at != edge[0][0]);
  return n_visited == edge.size();
}

static bool is_link_sound(const CutPatch& patch, const Corners& corner, std::int32_t i) {
  std::vector<std::int32_t> copy;
  for (const std::int32_t e : patch.star(i))
    for (std::size_t c = 0; c < 4; ++c)
      if (patch.corner[e][c] == i) copy.push_back(corner[e][c]);
  sort_unique(copy);
  return std::all_of(copy.begin(), copy.end(), [&](std::int32_t k) {
    return is_one_cycle(link_boundary(patch, corner, patch.star(i), k));
  });
}

// Number of edges of a facet where the opening ends inside the body.
static int rim_edges(const std::array<std::int32_t, 3>& node, const std::vector<EdgeEnds>& opened,
                     const std::vector<EdgeEnds>& outer) {
  std::vector<EdgeEnds> edge;
  add_edges(node, edge);
  int n = 0;
  for (const EdgeEnds& k : edge) {
    const auto use = std::equal_range(opened.begin(), opened.end(), k);
    if (use.second - use.first == 1 && !std::binary_search(outer.begin(), outer.end(), k)) ++n;
  }
  return n;
}

// The facet at node i to close first: most at the rim, then the farthest from the surface. -1:
// none.
static std::ptrdiff_t facet_to_close(const CutSurroundings& around,
                                     const std::vector<TetFacet>& facet, std::int32_t i,
                                     const std::vector<EdgeEnds>& opened,
                                     const std::vector<EdgeEnds>& outer) {
  std::ptrdiff_t best = -1;
  std::pair<int, double> best_rank;
  for (std::size_t k = 0; k < facet.size(); ++k) {
    const auto& [e, f] = facet[k];
    const std::array<std::int32_t, 3> node = facet_nodes(around.patch, e, f);
    if (std::find(node.begin(), node.end(), i) == node.end()) continue;
    const std::pair rank{rim_edges(node, opened, outer), facet_cost(around, e, f)};
    if (best >= 0 && rank <= best_rank) continue;
    best = static_cast<std::ptrdiff_t>(k);
    best_rank = rank;
  }
  return best;
}

// Nodes that must not stay as the opening has them: links that are no disc, and parted ones that
// are still to be moved.
static std::vector<std::int32_t> broken_nodes(const CutSurroundings& around,
                                              const std::vector<TetFacet>& facet,
                                              const std::vector<std::uint8_t>& stays_whole,
                                              const CutOpening& opening) {
  std::vector<std::int32_t> nodes, broken;
  for (const auto& [e, f] : facet)
    for (const std::int32_t i : facet_nodes(around.patch, e, f)) nodes.push_back(i);
  sort_unique(nodes);
  const std::vector<std::int32_t>& parent = opening.duplication.duplicate_parent;
  for (const std::int32_t i : nodes)
    if ((stays_whole[i] != 0 && std::binary_search(parent.begin(), parent.end(), i)) ||
        !is_link_sound(around.patch, opening.corner, i))
      broken.push_back(i);
  return broken;
}

// Closes one facet at each broken node; false if there was none to close.
static bool close_facets(const CutSurroundings& around, const std::vector<std::int32_t>& broken,
                         std::vector<TetFacet>& facet, CutOpening& opening) {
  if (broken.empty()) return false;
  const std::vector<EdgeEnds> outer = outer_edges(around.patch);
  std::vector<EdgeEnds> opened;
  for (const auto& [e, f] : facet) add_edges(facet_nodes(around.patch, e, f), opened);
  std::sort(opened.begin(), opened.end());
  bool is_changed = false;
  for (const std::int32_t i : broken) {
    const std::ptrdiff_t k = facet_to_close(around, facet, i, opened, outer);
    if (k < 0) continue;
    std::vector<EdgeEnds> closed;
    add_edges(facet_nodes(around.patch, facet[k][0], facet[k][1]), closed);
    for (const EdgeEnds& edge : closed) opened.erase(std::ranges::lower_bound(opened, edge));
    opening.refused.push_back(facet[k]);
    facet.erase(facet.begin() + k);
    is_changed = true;
  }
  return is_changed;
}

std::vector<std::uint8_t> unripe_nodes(const CutSurroundings& around, const CutLabels& labels) {
  std::vector<std::uint8_t> is_unripe = labels.is_front_node;
  for (std::int32_t i = 0; i < around.patch.n_nodes(); ++i)
    if (around.surface_cost[i] < ripe_distance * ripe_distance ||
        around.boundary[i].freedom == NodeFreedom::fixed)
      is_unripe[i] = 0;
  return is_unripe;
}

std::vector<std::int32_t> pinched_nodes(const CutSurroundings& around, const PatchMesh& mesh,
                                        const CutLabels& labels) {
  CutOpening opening;
  const std::vector<TetFacet> facet = facets_between_sides(around.patch, labels, opening.refused);
  split_nodes(around.patch, mesh, facet, opening);
  return broken_nodes(around, facet, std::vector<std::uint8_t>(around.patch.node.size(), 0),
                      opening);
}

CutOpening open_facets(const CutSurroundings& around, const PatchMesh& mesh,
                       const CutLabels& labels, const std::vector<std::uint8_t>& stays_whole) {
  CutOpening opening;
  std::vector<TetFacet> facet = facets_between_sides(around.patch, labels, opening.refused);
  do split_nodes(around.patch, mesh, facet, opening);
  while (close_facets(around, broken_nodes(around, facet, stays_whole, opening), facet, opening));
  return opening;
}

}  // namespace trocar
