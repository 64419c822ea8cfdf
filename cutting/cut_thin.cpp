// A walk from node to node along uncrossed edges, on one side of the blade.
#include "cutting/cut_thin.h"

#include <algorithm>
#include <cmath>

#include "base/segment.h"
#include "base/sort_unique.h"

namespace trocar {

// Of the nodes around a slice on the outer surface, where tissue is one or two elements thick: at
// the edge of a thick body they are less.
static constexpr double thin_share = 0.8;
// Of a slice's crossed edges from there to there.
static constexpr double outer_part = 0.7;
// Cosine of the outer normals of two faces that look away from each other.
static constexpr double away = -0.5;
// A corner this far beyond the surface (over h) still lies on this side.
static constexpr double tolerance = 0.05;
// Rings of thicker tissue that are split, too: a slice would come off from it at a neck.
static constexpr int n_rims = 3;

namespace {

// What the crossings say of a patch.
struct Crossings {
  const Mesh& mesh;
  const CutSurroundings& around;
  const CutStroke& stroke;
  std::vector<std::span<const CutHit>> hits;  // (n_elements)
  std::vector<const std::int8_t*> given;      // (n_elements) sides of earlier advances
  std::vector<std::uint8_t> is_made;          // (n_nodes) put on an edge by this stroke
  std::vector<std::uint8_t> is_outer;         // (n_nodes) on the outer surface, lips of cuts apart
  std::vector<std::uint8_t> is_lip;           // (n_nodes) on lips of cuts
  std::vector<std::uint8_t> votes;  // (n_nodes) by crossed edges: bit 0 for the + side, bit 1 for -
  std::vector<std::int32_t> twin;   // (n_nodes) the next node at its place that this stroke has
                                    // parted it from, in a ring

  // It doesn't say how thick the tissue was.
  bool is_on_lip_alone(std::int32_t i) const { return is_lip[i] != 0 && is_outer[i] == 0; }
  bool is_crossed(std::int32_t e, std::int32_t k) const {
    const auto [a, b] = tet_edges[k];
    const std::array<std::int32_t, 4>& c = around.patch.corner[e];
    return is_made[c[a]] == 0 && is_made[c[b]] == 0 &&
           std::ranges::find(hits[e], k, &CutHit::edge) != hits[e].end();
  }
};

// Where a slice's walk has come.
struct SliceWalk {
  const Crossings& c;
  ThinSlice slice;
  std::vector<std::uint8_t>& is_seen;  // (n_nodes)
  std::vector<std::uint8_t> is_next;   // (n_nodes) thicker tissue is next to the slice's node
};

}  // namespace

static std::vector<std::int32_t> twins_of(const CutPatch& patch, const CutStroke& stroke) {
  std::vector<std::int32_t> twin, parted;
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) twin.push_back(i);
  for (const std::int32_t node : stroke.parted_node)
    if (const std::int32_t i = patch.local_node(node); i >= 0) parted.push_back(i);
  std::ranges::stable_sort(parted, is_before,
                           [&](std::int32_t i) -> const Vec3& { return patch.X[i]; });
  for (std::size_t begin = 0, end = 0; begin < parted.size(); begin = end) {
    while (end < parted.size() && patch.X[parted[end]] == patch.X[parted[begin]]) ++end;
    for (std::size_t k = begin; k < end; ++k) twin[parted[k]] = parted[k + 1 < end ? k + 1 : begin];
  }
  return twin;
}

// Nodes on facets without a neighbour: that cuts have opened, or others.
static void mark_surface(const Mesh& mesh, const CutPatch& patch, Crossings& c) {
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 4; ++f) {
      if (!is_outer(patch, e, f)) continue;
      const bool is_opened = (mesh.cut_facets[patch.element[e]] >> f & 1) != 0;
      for (const std::int32_t i : facet_nodes(patch, e, f))
        (is_opened ? c.is_lip : c.is_outer)[i] = 1;
    }
}

static Crossings find_crossings(const Mesh& mesh, const CutSurroundings& around,
                                const CutStroke& stroke) {
  const CutPatch& patch = around.patch;
  const std::vector<std::uint8_t> none(patch.node.size(), 0);
  Crossings c{mesh,
              around,
              stroke,
              hits_of(stroke, patch.element),
              find_elements(stroke.side, patch.element),
              none,
              none,
              none,
              none,
              twins_of(patch, stroke)};
  mark_surface(mesh, patch, c);
  for (const std::int32_t node : stroke.made_node)
    if (const std::int32_t i = patch.local_node(node); i >= 0) c.is_made[i] = 1;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (const CutHit& hit : c.hits[e]) {
      const auto [a, b] = tet_edges[hit.edge];
      c.votes[patch.corner[e][a]] |= hit.is_first_plus ? 1 : 2;
      c.votes[patch.corner[e][b]] |= hit.is_first_plus ? 2 : 1;
    }
  return c;
}

// Whether element e lies on one side whole, by the surface near a node of it.
static bool shows(const Crossings& c, std::int32_t e, int side, const SurfacePlane& plane) {
  if (c.given[e] != nullptr) return *c.given[e] == side;
  for (const CutHit& hit : c.hits[e])
    if (c.is_crossed(e, hit.edge)) return false;
  return std::ranges::all_of(c.around.patch.corner[e], [&](std::int32_t i) {
    return c.is_made[i] != 0 ||
           side * plane.distance(c.around.patch.X[i]) > -tolerance * c.around.h;
  });
}

// By the node's crossed edges, else by its distance. 0: on the surface, or far from it.
static int side_of(const Crossings& c, std::int32_t i) {
  if (c.is_made[i] != 0 || c.votes[i] == 3) return 0;
  if (c.votes[i] != 0) return c.votes[i] == 1 ? 1 : -1;
  if (c.around.points.of(i).empty()) return 0;
  return c.around.distance[i] > 0 ? 1 : -1;
}

// Whether no element around the node and its twins shows its side.
static bool is_mute(const Crossings& c, std::int32_t i, int side) {
  const CutPatch& patch = c.around.patch;
  std::int32_t t = i;
  do {
    const std::span<const SurfacePoint> points = c.around.points.of(t);
    if (points.empty() || !patch.is_whole(t)) return false;
    const SurfacePlane plane = fit_surface(points, patch.X[t], c.around.h);
    if (std::ranges::any_of(patch.star(t),
                            [&](std::int32_t e) { return shows(c, e, side, plane); }))
      return false;
    t = c.twin[t];
  } while (t != i);
  return true;
}

// Other ends of the uncrossed edges at node i and its twins, but for nodes on the surface.
static std::vector<std::int32_t> next_nodes(const Crossings& c, std::int32_t i) {
  const CutPatch& patch = c.around.patch;
  std::vector<std::int32_t> next;
  std::int32_t t = i;
  do {
    for (const std::int32_t e : patch.star(t))
      for (std::int32_t k = 0; k < 6; ++k) {
        const auto [a, b] = tet_edges[k];
        const std::int32_t p = patch.corner[e][a], q = patch.corner[e][b];
        if ((p == t || q == t) && !c.is_crossed(e, k)) next.push_back(p == t ? q : p);
      }
    t = c.twin[t];
  } while (t != i);
  sort_unique(next);
  std::erase_if(next, [&](std::int32_t j) { return c.is_made[j] != 0 || c.votes[j] == 3; });
  return next;
}

static void visit(SliceWalk& walk, std::int32_t i) {
  const int side = walk.slice.side;
  for (const std::int32_t j : next_nodes(walk.c, i)) {
    const int s = side_of(walk.c, j);
    if (s == -side) continue;
    if (s == 0 || !is_mute(walk.c, j, side)) {
      walk.is_next[i] = 1;
      if (walk.c.votes[j] != 0) walk.slice.rim.push_back(j);
    } else if (walk.is_seen[j] == 0) {
      walk.is_seen[j] = 1;
      walk.slice.node.push_back(j);
    }
  }
}

static void widen_rim(const Crossings& c, ThinSlice& slice) {
  sort_unique(slice.rim);
  for (int k = 1; k < n_rims; ++k) {
    std::vector<std::int32_t> more;
    for (const std::int32_t i : slice.rim)
      for (const std::int32_t j : next_nodes(c, i))
        if (side_of(c, j) == slice.side && c.votes[j] != 0) more.push_back(j);
    slice.rim.insert(slice.rim.end(), more.begin(), more.end());
    sort_unique(slice.rim);
  }
}

// Part of a tetrahedron's volume where a linear function of these values at its corners is
// positive: the sum of f_k^3 / prod (f_k - f_m), m != k, over positive f_k. Equal values are moved
// apart.
static double positive_part(std::array<double, 4> f) {
  const double scale = std::max({std::abs(f[0]), std::abs(f[1]), std::abs(f[2]), std::abs(f[3])});
  if (scale == 0) return 0;
  for (std::size_t k = 0; k < 4; ++k) f[k] += 1e-5 * scale * static_cast<double>(k + 1);
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    double part = f[k] > 0 ? f[k] * f[k] * f[k] : 0;
    for (std::size_t m = 0; m < 4; ++m)
      if (m != k) part /= f[k] - f[m];
    sum += part;
  }
  return std::clamp(sum, 0.0, 1.0);
}

static double volume_on_side(const Crossings& c, std::int32_t e, int side) {
  const CutPatch& patch = c.around.patch;
  const double V = six_volumes(patch.X, patch.corner[e]) / 6;
  if (c.hits[e].empty()) return V;
  const CutHit& hit = c.hits[e].front();
  std::array<double, 4> f{};
  for (std::size_t k = 0; k < 4; ++k) f[k] = side * hit.N.dot(patch.X[patch.corner[e][k]] - hit.X);
  return V * positive_part(f);
}

// Around nodes that are not next to thicker tissue.
static double deep_volume(const SliceWalk& walk) {
  std::vector<std::int32_t> element;
  for (const std::int32_t i : walk.slice.node)
    if (walk.is_next[i] == 0)
      element.insert(element.end(), walk.c.around.patch.star(i).begin(),
                     walk.c.around.patch.star(i).end());
  sort_unique(element);
  double V = 0;
  for (const std::int32_t e : element) V += volume_on_side(walk.c, e, walk.slice.side);
  return V;
}

// Calls body(element, crossing) for the crossed edges at node i.
template <class Body>
static void for_crossed(const Crossings& c, std::int32_t i, const Body& body) {
  const CutPatch& patch = c.around.patch;
  if (!patch.is_whole(i)) return;
  for (const std::int32_t e : patch.star(i))
    for (const CutHit& hit : c.hits[e]) {
      const auto [a, b] = tet_edges[hit.edge];
      const std::int32_t p = patch.corner[e][a], q = patch.corner[e][b];
      if ((p == i || q == i) && c.is_crossed(e, hit.edge)) body(p, q, hit.X);
    }
}

static bool is_in_thin_tissue(const Crossings& c, const ThinSlice& slice) {
  const CutPatch& patch = c.around.patch;
  std::vector<std::int32_t> near;
  for (const std::vector<std::int32_t>* nodes : {&slice.node, &slice.rim})
    for (const std::int32_t i : *nodes)
      for (const std::int32_t e : patch.star(i))
        near.insert(near.end(), patch.corner[e].begin(), patch.corner[e].end());
  sort_unique(near);
  const auto n_outer =
      std::ranges::count_if(near, [&](std::int32_t i) { return c.is_outer[i] != 0; });
  return static_cast<double>(n_outer) >= thin_share * static_cast<double>(near.size());
}

// Whether the outer surface at node p looks away from that at q.
static bool look_away(const Crossings& c, std::int32_t p, std::int32_t q) {
  const CutPatch& patch = c.around.patch;
  if (!patch.is_whole(p) || !patch.is_whole(q)) return false;
  const auto normals_at = [&](std::int32_t i) {
    return outer_normals(patch, c.stroke, c.mesh.cut_facets, i);
  };
  const std::vector<Vec3> at_p = normals_at(p), at_q = normals_at(q);
  return std::ranges::any_of(at_p, [&](const Vec3& a) {
    return std::ranges::any_of(at_q, [&](const Vec3& b) { return a.dot(b) < away; });
  });
}

// Whether an element around the slice reaches from one face of the body to the other. At the edge
// of a thick body none does: the faces that meet there don't look away from each other.
static bool reaches_both_faces(const Crossings& c, const ThinSlice& slice) {
  const CutPatch& patch = c.around.patch;
  return std::ranges::any_of(slice.node, [&](std::int32_t i) {
    return std::ranges::any_of(patch.star(i), [&](std::int32_t e) {
      return std::ranges::any_of(tet_edges, [&](const std::array<int, 2>& end) {
        return look_away(c, patch.corner[e][end[0]], patch.corner[e][end[1]]);
      });
    });
  });
}

static bool is_one_element_thick(const Crossings& c, const ThinSlice& slice) {
  double n = 0, n_outer = 0;
  for (const std::int32_t i : slice.node)
    for_crossed(c, i, [&](std::int32_t p, std::int32_t q, const Vec3& /*X*/) {
      if (c.is_on_lip_alone(p) || c.is_on_lip_alone(q)) return;
      n += 1;
      n_outer += c.is_outer[p] != 0 && c.is_outer[q] != 0 ? 1 : 0;
    });
  return n_outer >= outer_part * n && reaches_both_faces(c, slice);
}

// Borders of areas are left as they are, and so is what lies on both sides.
static void find_crossed_edges(const Crossings& c, ThinSlice& slice) {
  const CutPatch& patch = c.around.patch;
  const auto add = [&](std::int32_t p, std::int32_t q, const Vec3& X) {
    const std::int32_t a = std::min(p, q), b = std::max(p, q);
    if (c.votes[a] == 3 || c.votes[b] == 3) return;
    if (std::ranges::binary_search(patch.border, BorderEdge{a, b})) return;
    const Vec3 way = patch.X[b] - patch.X[a];
    slice.crossing.push_back(
        {.end = {patch.node[a], patch.node[b]}, .s = share_on_line(patch.X[a], way, X)});
  };
  for (const std::int32_t i : slice.node) for_crossed(c, i, add);
  for (const std::int32_t i : slice.rim) for_crossed(c, i, add);
}

// All mute nodes that hang together with `first`, which is one.
static ThinSlice slice_of(const Crossings& c, std::int32_t first,
                          std::vector<std::uint8_t>& is_seen) {
  SliceWalk walk{.c = c,
                 .slice = {.side = side_of(c, first), .node = {first}},
                 .is_seen = is_seen,
                 .is_next = std::vector<std::uint8_t>(is_seen.size(), 0)};
  is_seen[first] = 1;
  for (std::size_t k = 0; k < walk.slice.node.size(); ++k) visit(walk, walk.slice.node[k]);
  walk.slice.V = deep_volume(walk);
  widen_rim(c, walk.slice);
  find_crossed_edges(c, walk.slice);
  return std::move(walk.slice);
}

std::vector<ThinSlice> thin_slices(const Mesh& mesh, const CutSurroundings& around,
                                   const CutStroke& stroke) {
  const CutPatch& patch = around.patch;
  const Crossings c = find_crossings(mesh, around, stroke);
  std::vector<std::uint8_t> is_seen(patch.node.size(), 0);
  std::vector<ThinSlice> slices;
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) {
    if (c.is_outer[i] == 0 || is_seen[i] != 0 || c.votes[i] == 0) continue;
    if (side_of(c, i) == 0 || !is_mute(c, i, side_of(c, i))) continue;
    ThinSlice slice = slice_of(c, i, is_seen);
    if (is_in_thin_tissue(c, slice) && is_one_element_thick(c, slice))
      slices.push_back(std::move(slice));
  }
  return slices;
}

void leave_slices(const CutPatch& patch, const std::vector<ThinSlice>& slices, CutLabels& labels) {
  for (const ThinSlice& slice : slices)
    for (const std::vector<std::int32_t>* nodes : {&slice.node, &slice.rim})
      for (const std::int32_t i : *nodes) leave_elements(patch, patch.star(i), labels);
}

}  // namespace trocar
