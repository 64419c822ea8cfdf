// Recovery of chain edges by flips, as in constrained Delaunay triangulation (Sloan 1993): the
// paper's first mesh error, an edge that crosses a segment of the cut.
#include <cmath>
#include <deque>

#include "cutting/cut_plane_chain.h"

namespace trocar {

namespace {

constexpr double on_segment = 1e-6;    // h
constexpr double nudge = 0.02;         // h
constexpr double least_convex = 1e-6;  // of the mean area

using Edge = std::array<int, 2>;

// Edges between nodes a and b, or the node that lies in the way.
struct Corridor {
  std::vector<Edge> crossing;
  int blocking_node = -1;
  bool is_blocked = false;  // by a boundary or a cut
  bool is_edge = false;
};

struct Segment {
  const PlanePatch& patch;
  int a, b;
  Vec2 from, direction;
  double tolerance;

  double side(int i) const { return cross(direction, patch.x[i] - from); }
  bool is_on(int i) const { return std::abs(side(i)) < tolerance * direction.norm(); }
  bool is_ahead(int i) const { return direction.dot(patch.x[i] - from) > 0; }
};

// The facet opposite a through which the segment leaves the star of a.
PatchFacet first_facet(const Segment& segment, Corridor& corridor) {
  PatchFacet found;
  visit_star(segment.patch, segment.a, [&](int e, int k) {
    const int u = segment.patch.corner[e][(k + 1) % 3], v = segment.patch.corner[e][(k + 2) % 3];
    for (const int i : {u, v}) {
      if (i == segment.b)
        corridor.is_edge = true;
      else if (segment.is_on(i) && segment.is_ahead(i))
        corridor.blocking_node = i;
    }
    if (segment.side(u) < 0 && segment.side(v) > 0 &&
        cross(segment.patch.x[u] - segment.from, segment.patch.x[v] - segment.from) > 0)
      found = {e, k};
    return !corridor.is_edge;
  });
  return found;
}

Corridor find_corridor(const PlanePatch& patch, int a, int b) {
  const Segment segment{patch, a, b, patch.x[a], patch.x[b] - patch.x[a], on_segment * patch.h};
  Corridor corridor;
  PatchFacet facet = first_facet(segment, corridor);
  if (corridor.is_edge) corridor.blocking_node = -1;
  if (corridor.is_edge || corridor.blocking_node >= 0) return corridor;
  corridor.is_blocked = facet.element < 0;
  while (!corridor.is_blocked) {
    if (!is_flippable(patch, facet)) {
      corridor.is_blocked = true;
      break;
    }
    const std::array<int, 3>& e = patch.corner[facet.element];
    corridor.crossing.push_back({e[(facet.facet + 1) % 3], e[(facet.facet + 2) % 3]});
    const PatchFacet other = opposite(patch, facet);
    const int z = patch.corner[other.element][other.facet];
    if (z == b) break;
    if (segment.is_on(z)) {
      corridor.blocking_node = z;
      break;
    }
    // In the element across, the corner after z is the left end of the edge that was crossed.
    facet = {other.element, (other.facet + (segment.side(z) > 0 ? 1 : 2)) % 3};
  }
  return corridor;
}

// Moves a node that lies on the segment a little to the side of the cut on which it is.
bool nudge_node(PlanePatch& patch, const CutChain& chain, int i, const Vec2& along) {
  if (patch.is_held[i] != 0 || patch.is_boundary[i] != 0 || i == chain.path.tip) return false;
  if (patch.has_interfaces() && patch.is_interface[i] != 0) return false;
  for (const int k : chain.node)
    if (k == i) return false;
  const Vec2 normal = Vec2(-along.y(), along.x()).normalized();
  const double s = 0.5 * chain.path.length();
  const Vec2 offset = patch.x[i] - position(chain.path, s);
  const double side = cross(tangent(chain.path, s), offset) < 0 ? -1 : 1;
  const Vec2 before = patch.x[i];
  patch.x[i] += side * nudge * patch.h * normal;
  bool is_valid = true;
  visit_star(patch, i, [&](int e, int) {
    is_valid = is_valid && area(patch, e) > 0;
    return is_valid;
  });
  if (!is_valid) patch.x[i] = before;
  return is_valid;
}

bool is_crossing(const PlanePatch& patch, int a, int b, const Edge& edge) {
  for (const int i : edge)
    if (i == a || i == b) return false;
  const Vec2 d = patch.x[b] - patch.x[a];
  return (cross(d, patch.x[edge[0]] - patch.x[a]) > 0) !=
         (cross(d, patch.x[edge[1]] - patch.x[a]) > 0);
}

bool flip_corridor(PlanePatch& patch, int a, int b, const std::vector<Edge>& crossing) {
  std::deque<Edge> open(crossing.begin(), crossing.end());
  std::size_t n_left = 4 * crossing.size() * crossing.size() + 4;
  while (!open.empty() && n_left-- > 0) {
    const Edge edge = open.front();
    open.pop_front();
    const PatchFacet facet = find_edge(patch, edge[0], edge[1]);
    if (facet.element < 0 || !is_flippable(patch, facet)) return false;
    if (flipped_area(patch, facet) < least_convex) {
      open.push_back(edge);
      continue;
    }
    flip(patch, facet);
    const int w = patch.corner[facet.element][facet.facet];
    const int z = patch.corner[facet.element][(facet.facet + 2) % 3];
    if (is_crossing(patch, a, b, {w, z})) open.push_back({w, z});
  }
  return open.empty();
}

bool recover_edge(PlanePatch& patch, const CutChain& chain, int a, int b) {
  for (int round = 0; round < 8; ++round) {
    const Corridor corridor = find_corridor(patch, a, b);
    if (corridor.is_edge) return true;
    if (corridor.is_blocked) return false;
    if (corridor.blocking_node >= 0) {
      if (!nudge_node(patch, chain, corridor.blocking_node, patch.x[b] - patch.x[a])) return false;
    } else if (!flip_corridor(patch, a, b, corridor.crossing)) {
      return false;
    }
  }
  return false;
}

void mark_chain_edge(PlanePatch& patch, PatchFacet facet) {
  const PatchFacet other = opposite(patch, facet);
  for (const PatchFacet& side : {facet, other})
    patch.chain[side.element] =
        static_cast<std::uint8_t>(patch.chain[side.element] | 1U << side.facet);
}

}  // namespace

bool recover_edges(PlanePatch& patch, const CutChain& chain) {
  for (int k = 0; k < chain.n_segments(); ++k) {
    const int a = chain.node[k], b = chain.node[k + 1];
    if (!recover_edge(patch, chain, a, b)) return false;
    const PatchFacet facet = find_edge(patch, a, b);
    if (facet.element < 0 || patch.across[facet.element][facet.facet] < 0) return false;
    mark_chain_edge(patch, facet);
  }
  return true;
}

}  // namespace trocar
