// Extraction of the patch around a cut: rings over the stars of nodes.
#include "cutting/cut_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/sort_unique.h"
#include "base/triangle.h"
#include "cutting/cut_stroke.h"

namespace trocar {

std::int32_t CutPatch::local_node(std::int32_t global) const {
  return find_in(node, global);
}
std::int32_t CutPatch::local_element(std::int32_t global) const {
  return find_in(element, global);
}

std::array<std::int32_t, 3> facet_nodes(const CutPatch& patch, std::int32_t e, int f) {
  const std::array<std::int32_t, 4>& corner = patch.corner[e];
  const std::array<int, 3>& facet = tet_facets[f];
  return {corner[facet[0]], corner[facet[1]], corner[facet[2]]};
}

Vec3 facet_normal(const CutPatch& patch, const std::array<std::int32_t, 3>& node) {
  return area_normal({patch.X[node[0]], patch.X[node[1]], patch.X[node[2]]});
}

bool is_outer(const CutPatch& patch, std::int32_t e, int f) {
  return patch.across[e][f] < 0 &&
         std::ranges::any_of(facet_nodes(patch, e, f), [&](auto i) { return patch.is_whole(i); });
}

int facet_towards(const CutPatch& patch, std::int32_t e, std::int32_t u) {
  const std::array<std::int32_t, 4>& across = patch.across[e];
  return static_cast<int>(std::find(across.begin(), across.end(), u) - across.begin());
}

double six_volumes(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner) {
  const Vec3& o = X[corner[0]];
  return (X[corner[1]] - o).cross(X[corner[2]] - o).dot(X[corner[3]] - o);
}

double step_bound(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner) {
  const Vec3& o = X[corner[0]];
  const Vec3 a = X[corner[1]] - o, b = X[corner[2]] - o, c = X[corner[3]] - o;
  const Vec3 n = a.cross(b), m = b.cross(c), k = c.cross(a);  // of length 2 area
  const double S = n.squaredNorm() + m.squaredNorm() + k.squaredNorm() + (n + m + k).squaredNorm();
  return n.dot(c) / std::sqrt(S);
}

double star_step(const CutPatch& patch, std::span<const Vec3> X, std::int32_t i) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t e : patch.star(i))
    least = std::min(least, step_bound(X, patch.corner[e]));
  return least;
}

Vec3 centre_of(const CutPatch& patch, std::span<const std::int32_t> element) {
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t e : element)
    for (const std::int32_t i : patch.corner[e]) sum += patch.X[i];
  return sum / static_cast<double>(4 * element.size());
}

// Marks the nodes around the seeds with their rings; returns them, ascending.
static std::vector<std::int32_t> mark_rings(const Mesh& mesh, std::span<const std::int32_t> seeds,
                                            CutIndex& index) {
  std::vector<std::int32_t> reached;
  const auto reach = [&](std::int32_t e, int ring) {
    for (const std::int32_t i : mesh.corners(e)) {
      if (index.ring[i] != no_ring) continue;
      index.ring[i] = static_cast<std::uint8_t>(ring);
      reached.push_back(i);
    }
  };
  for (const std::int32_t e : seeds) reach(e, 0);
  std::size_t begin = 0;
  for (int ring = 1; ring <= n_cut_rings; ++ring) {
    const std::size_t end = reached.size();
    for (; begin < end; ++begin)
      for (const std::int32_t e : index.star(reached[begin])) reach(e, ring);
  }
  sort_unique(reached);
  return reached;
}

// Elements with a corner in a ring below n_cut_rings, ascending.
static std::vector<std::int32_t> elements_of(const Mesh& mesh, const CutIndex& index,
                                             std::span<const std::int32_t> reached) {
  std::vector<std::int32_t> element;
  const auto is_inner = [&](std::int32_t i) { return index.ring[i] < n_cut_rings; };
  for (const std::int32_t i : reached) {
    if (!is_inner(i)) continue;
    for (const std::int32_t e : index.star(i)) {
      const std::span<const std::int32_t> c = mesh.corners(e);
      if (*std::find_if(c.begin(), c.end(), is_inner) == i) element.push_back(e);
    }
  }
  sort_unique(element);
  return element;
}

static void set_stars(CutPatch& patch) {
  patch.stars = group_items(patch.node.size(), [&](const auto& put) {
    for (std::int32_t e = 0; e < patch.n_elements(); ++e)
      for (const std::int32_t i : patch.corner[e]) put(i, e);
  });
}

static void sort3(std::array<std::int32_t, 3>& v) {
  if (v[0] > v[1]) std::swap(v[0], v[1]);
  if (v[1] > v[2]) std::swap(v[1], v[2]);
  if (v[0] > v[1]) std::swap(v[0], v[1]);
}

namespace {

// Facets whose neighbours no patch has found yet, in a list at their lowest node.
struct Pairing {
  CutPatch& patch;
  CutIndex& index;
  std::vector<std::int32_t> first;  // (n_nodes of the patch) in index.waiting, -1: none
};

}  // namespace

// Pairs facet f of element e with the one that waits for it, or lets it wait.
static void pair_facet(Pairing& p, std::int32_t e, int f) {
  std::array<std::int32_t, 3> node = facet_nodes(p.patch, e, f);
  sort3(node);
  std::vector<WaitingFacet>& waiting = p.index.waiting;
  for (std::int32_t* at = &p.first[node[0]]; *at >= 0; at = &waiting[*at].next) {
    const WaitingFacet other = waiting[*at];
    if (other.middle != node[1] || other.high != node[2]) continue;
    p.patch.across[e][f] = other.element;
    p.patch.across[other.element][other.facet] = e;
    p.index.across[p.patch.element[e]][f] = p.patch.element[other.element];
    p.index.across[p.patch.element[other.element]][other.facet] = p.patch.element[e];
    *at = other.next;
    return;
  }
  waiting.push_back({node[1], node[2], e, f, p.first[node[0]]});
  p.first[node[0]] = static_cast<std::int32_t>(waiting.size()) - 1;
}

// Facets that still wait at node i have no neighbour if all elements of one of their nodes are
// in the patch.
static void end_waiting(Pairing& p, std::int32_t i) {
  for (std::int32_t at = p.first[i]; at >= 0; at = p.index.waiting[at].next) {
    const WaitingFacet& w = p.index.waiting[at];
    if (p.patch.is_whole(i) || p.patch.is_whole(w.middle) || p.patch.is_whole(w.high))
      p.index.across[p.patch.element[w.element]][w.facet] = -1;
  }
}

static void set_neighbours(CutPatch& patch, CutIndex& index) {
  patch.across.assign(patch.corner.size(), {-1, -1, -1, -1});
  for (std::int32_t e = 0; e < patch.n_elements(); ++e) index.local_element[patch.element[e]] = e;
  Pairing pairing{patch, index, std::vector<std::int32_t>(patch.node.size(), -1)};
  index.waiting.clear();
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 4; ++f) {
      const std::int32_t u = index.across[patch.element[e]][f];
      if (u == not_known)
        pair_facet(pairing, e, f);
      else if (u >= 0)
        patch.across[e][f] = index.local_element[u];
    }
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) end_waiting(pairing, i);
  for (const std::int32_t e : patch.element) index.local_element[e] = -1;
}

// Nodes that the patch's tetrahedra use, in ascending order, and the elements in these numbers.
static void number_nodes(CutPatch& patch, const Mesh& mesh, std::span<const std::int32_t> reached,
                         CutIndex& index) {
  for (const std::int32_t e : patch.element)
    for (const std::int32_t i : mesh.corners(e)) index.local[i] = 0;
  for (const std::int32_t i : reached) {
    if (index.local[i] < 0) continue;
    index.local[i] = patch.n_nodes();
    patch.node.push_back(i);
    patch.node_ring.push_back(index.ring[i]);
  }
  for (const std::int32_t e : patch.element) {
    const std::span<const std::int32_t> c = mesh.corners(e);
    patch.corner.push_back(
        {index.local[c[0]], index.local[c[1]], index.local[c[2]], index.local[c[3]]});
  }
}

static void set_regions(CutPatch& patch, const Mesh& mesh) {
  if (mesh.region_name.size() < 2) return;
  for (const std::int32_t e : patch.element) patch.region.push_back(mesh.element_region[e]);
}

static void set_border(CutPatch& patch, std::span<const BorderEdge> border, const CutIndex& index) {
  for (const auto& [a, b] : border) {
    const std::int32_t i = index.local[a], j = index.local[b];
    if (i >= 0 && j >= 0) patch.border.insert(patch.border.end(), {{i, j}, {j, i}});
  }
  sort_unique(patch.border);
}

CutPatch make_patch(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
                    const CutConstraints& constraints, std::span<const std::int32_t> seeds) {
  const std::vector<std::int32_t> reached = mark_rings(mesh, seeds, index);
  CutPatch patch;
  std::vector<std::int32_t> joined;
  for (const std::int32_t e : elements_of(mesh, index, reached)) {
    if (mesh.element_type[e] == ElementType::tet4)
      patch.element.push_back(e);
    else
      joined.insert(joined.end(), mesh.corners(e).begin(), mesh.corners(e).end());
  }
  number_nodes(patch, mesh, reached, index);
  set_stars(patch);
  set_neighbours(patch, index);
  set_regions(patch, mesh);
  set_border(patch, constraints.border, index);
  patch.is_joined.assign(patch.node.size(), 0);
  patch.is_bent.assign(patch.node.size(), 0);
  for (const std::int32_t i : joined)
    if (index.local[i] >= 0) patch.is_joined[index.local[i]] = 1;
  positions.find(patch.node);
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) {
    patch.X.push_back(mesh.X[patch.node[i]]);
    patch.x.push_back(positions.x()[patch.node[i]]);
    const bool is_locked = constraints.is_held[patch.node[i]] != 0 || patch.is_joined[i] != 0;
    patch.is_locked.push_back(is_locked ? 1 : 0);
  }
  for (const std::int32_t i : reached) {
    index.ring[i] = no_ring;
    index.local[i] = -1;
  }
  return patch;
}

double tet_step_bound(const Mesh& mesh, std::int32_t e) {
  return step_bound(mesh.X, tet_nodes(mesh, e));
}

double tet_mean_edge(const Mesh& mesh, std::int32_t e) {
  const std::span<const std::int32_t> c = mesh.corners(e);
  double sum = 0;
  for (const auto& [a, b] : tet_edges) sum += (mesh.X[c[a]] - mesh.X[c[b]]).norm();
  return sum / static_cast<double>(tet_edges.size());
}

double least_share(const std::array<Vec3, 3>& triangle, const Vec3& X) {
  const Vec3 p = triangle[1] - triangle[0], q = triangle[2] - triangle[0], way = X - triangle[0];
  const Vec3 n = p.cross(q);
  const double v = n.dot(way.cross(q)) / n.squaredNorm(), w = n.dot(p.cross(way)) / n.squaredNorm();
  return std::min({v, w, 1 - v - w});
}

}  // namespace trocar
