// Bisection, and a stroke's memory across it.
#include "cutting/cut_split.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "cutting/cut_follow.h"

namespace trocar {

using Tet = std::array<std::int32_t, 4>;
using EdgeEnds = std::array<std::int32_t, 2>;

// The first inserted node on an edge of the tetrahedron, -1: none.
static std::ptrdiff_t first_on_edge(std::span<const EdgeNode> inserted, const Tet& tet) {
  std::ptrdiff_t first = -1;
  for (const auto& [a, b] : tet_edges) {
    const std::int32_t i = tet[a], j = tet[b];
    const EdgeEnds end{std::min(i, j), std::max(i, j)};
    const auto at = std::ranges::lower_bound(inserted, end, {}, &EdgeNode::end);
    if (at == inserted.end() || at->end != end) continue;
    const std::ptrdiff_t k = at - inserted.begin();
    if (first < 0 || k < first) first = k;
  }
  return first;
}

// Adds the parts of `tet` to the split.
static void bisect(std::span<const EdgeNode> inserted, std::int32_t first_inserted, const Tet& tet,
                   ElementSplit& split) {
  const std::ptrdiff_t k = first_on_edge(inserted, tet);
  if (k < 0) {
    CHECK_OP(split.n_tets, <, max_split_tets);
    split.corner[split.n_tets++] = tet;
    return;
  }
  for (const std::int32_t end : inserted[k].end) {
    Tet half = tet;
    std::ranges::replace(half, end, first_inserted + static_cast<std::int32_t>(k));
    bisect(inserted, first_inserted, half, split);
  }
}

MeshEdit split_edges(const Mesh& mesh, std::span<const std::int32_t> element,
                     std::vector<EdgeNode> inserted) {
  MeshEdit edit;
  edit.inserted = std::move(inserted);
  for (const std::int32_t e : element) {
    const Tet tet = tet_nodes(mesh, e);
    if (first_on_edge(edit.inserted, tet) < 0) continue;
    edit.splits.push_back({.element = e, .n_tets = 0});
    bisect(edit.inserted, mesh.n_nodes(), tet, edit.splits.back());
  }
  return edit;
}

namespace {

// An edit that inserts nodes, and the mesh before it.
struct Inserted {
  const Mesh& mesh;
  const MeshEdit& edit;
  SplitNumbers numbers;

  Vec3 X(std::int32_t i) const {
    return i < mesh.n_nodes() ? mesh.X[i] : position_of(mesh, edit.inserted[i - mesh.n_nodes()]);
  }
  // Where node i is on the way from node a to b: 0 … 1; -1 if it is not on this edge.
  double place_on(std::int32_t i, std::int32_t a, std::int32_t b) const {
    if (i == a || i == b) return i == a ? 0 : 1;
    if (i < mesh.n_nodes()) return -1;
    const EdgeNode& node = edit.inserted[i - mesh.n_nodes()];
    if (node.end != EdgeEnds{std::min(a, b), std::max(a, b)}) return -1;
    return node.end[0] == a ? node.s : 1 - node.s;
  }
};

}  // namespace

// The crossing on the edges of the parts of its element; where a new node is, on both sides of it.
static void split_hit(const Inserted& after, const ElementSplit& split, const CutHit& hit,
                      std::vector<CutHit>& hits) {
  constexpr double tolerance = 1e-9;
  const Tet whole = tet_nodes(after.mesh, hit.element);
  const auto [c, d] = tet_edges[hit.edge];
  const std::int32_t a = whole[c], b = whole[d];
  const Vec3 way = after.mesh.X[b] - after.mesh.X[a];
  const double s = share_on_line(after.mesh.X[a], way, hit.X);
  for (std::int32_t k = 0; k < split.n_tets; ++k)
    for (std::int32_t e = 0; e < 6; ++e) {
      const Tet& part = split.corner[k];
      const auto [p, q] = tet_edges[e];
      const double s0 = after.place_on(part[p], a, b), s1 = after.place_on(part[q], a, b);
      if (s0 < 0 || s1 < 0 || s < std::min(s0, s1) - tolerance || s > std::max(s0, s1) + tolerance)
        continue;
      CutHit now = hit;
      now.element = after.numbers.part(hit.element, k);
      now.edge = e;
      now.is_first_plus = (s0 < s1) == hit.is_first_plus;
      hits.push_back(now);
    }
}

static void follow_hits(const Inserted& after, std::vector<CutHit>& hits) {
  std::vector<CutHit> now;
  now.reserve(hits.size());
  for (const CutHit& hit : hits) {
    if (const ElementSplit* const split = after.numbers.find(hit.element))
      split_hit(after, *split, hit, now);
    else
      now.push_back(hit);
  }
  std::ranges::sort(now, {}, &CutHit::key);
  hits = std::move(now);
}

// Parts have what their element had. Those that come behind all elements do so in the elements'
// order.
template <class T>
static void follow_values(const Inserted& after, std::vector<OfElement<T>>& values) {
  for (std::size_t i = 0, n = values.size(); i < n; ++i) {
    const OfElement<T> entry = values[i];
    if (const ElementSplit* const split = after.numbers.find(entry.element))
      for (std::int32_t k = 1; k < split->n_tets; ++k)
        values.push_back({after.numbers.part(entry.element, k), entry.value});
  }
}

static void follow_opened(const Inserted& after, std::vector<OfElement<std::uint8_t>>& opened) {
  follow_values(after, opened);
  for (OfElement<std::uint8_t>& entry : opened) {
    const std::int32_t e = after.numbers.whole(entry.element);
    const ElementSplit* const split = after.numbers.find(e);
    if (split == nullptr) continue;
    const auto part = static_cast<std::size_t>(after.numbers.place_in_whole(entry.element));
    entry.value = facets_of_part(after.mesh.corners(e), entry.value, after.edit.inserted,
                                 after.mesh.n_nodes(), split->corner[part]);
  }
}

// Least barycentric coordinate of X in the tetrahedron.
static double depth_in(const Inserted& after, const Tet& tet, const Vec3& X) {
  constexpr Tet all{0, 1, 2, 3};
  std::array<Vec3, 4> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = after.X(tet[k]);
  double least = std::numeric_limits<double>::infinity();
  for (Vec3& corner : p) {
    const Vec3 own = std::exchange(corner, X);
    least = std::min(least, six_volumes(p, all));
    corner = own;
  }
  return least / six_volumes(p, all);
}

static void follow_edge(const Inserted& after, std::vector<BladePoint>& edge) {
  for (BladePoint& point : edge) {
    if (point.element < 0) continue;
    const ElementSplit* const split = after.numbers.find(point.element);
    if (split == nullptr) continue;
    double most = -std::numeric_limits<double>::infinity();
    std::int32_t best = 0;
    for (std::int32_t k = 0; k < split->n_tets; ++k) {
      const double depth = depth_in(after, split->corner[k], point.X);
      if (depth <= most) continue;
      most = depth;
      best = k;
    }
    point.element = after.numbers.part(point.element, best);
  }
}

// (ascending by node) The side that crossed edges put each node on, the first one's.
static std::vector<OfElement<std::int8_t>> node_sides(const Mesh& mesh, const CutStroke& stroke) {
  std::vector<OfElement<std::int8_t>> sides;
  for (const CutHit& hit : stroke.hit) {
    const auto [a, b] = tet_edges[hit.edge];
    const Tet c = tet_nodes(mesh, hit.element);
    const std::int8_t side = hit.is_first_plus ? 1 : -1;
    sides.push_back({c[a], side});
    sides.push_back({c[b], static_cast<std::int8_t>(-side)});
  }
  sort_unique_by(sides, &OfElement<std::int8_t>::element);
  return sides;
}

// That of the corners that are not on the surface; 0 if they lie on both sides, or one is not
// known.
static std::int8_t side_of(std::span<const OfElement<std::int8_t>> sides, const Mesh& mesh,
                           const CutStroke& stroke, const Tet& part) {
  std::int8_t side = 0;
  for (const std::int32_t i : part) {
    if (i >= mesh.n_nodes() || std::ranges::binary_search(stroke.surface_node, i)) continue;
    const auto at = std::ranges::lower_bound(sides, i, {}, &OfElement<std::int8_t>::element);
    const bool is_known = at != sides.end() && at->element == i;
    if (!is_known || at->value == -side) return 0;
    side = at->value;
  }
  return side;
}

// Parts are too small to say how fine a mesh is.
static void keep_edges(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke) {
  std::vector<OfElement<double>> edge;
  for (const ElementSplit& split : edit.splits)
    if (find_element(stroke.whole_edge, split.element) == nullptr)
      edge.push_back({split.element, tet_mean_edge(mesh, split.element)});
  merge_elements(stroke.whole_edge, edge);
}

void split_stroke(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke) {
  const std::vector<OfElement<std::int8_t>> sides = node_sides(mesh, stroke);
  follow_splits(mesh, edit, stroke);
  const SplitNumbers numbers(edit.splits, mesh.n_elements());
  std::vector<OfElement<std::int8_t>> part_side;  // of all parts, 0: not known
  for (const ElementSplit& split : edit.splits)
    for (std::int32_t k = 0; k < split.n_tets; ++k) {
      const std::int32_t e = numbers.part(split.element, k);
      part_side.push_back({e, side_of(sides, mesh, stroke, split.corner[k])});
      stroke.fresh.push_back(e);
    }
  sort_unique(stroke.fresh);
  std::ranges::sort(part_side, {}, &OfElement<std::int8_t>::element);
  merge_elements(stroke.side, part_side);
  std::erase_if(stroke.side, [](const OfElement<std::int8_t>& entry) { return entry.value == 0; });
  for (std::int32_t k = 0; k < std::ssize(edit.inserted); ++k)
    stroke.made_node.push_back(mesh.n_nodes() + k);
}

void follow_splits(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke) {
  std::vector<std::int32_t> whole;
  for (const ElementSplit& split : edit.splits) whole.push_back(split.element);
  keep_steps(mesh, whole, stroke);
  keep_edges(mesh, edit, stroke);
  const Inserted after{mesh, edit, SplitNumbers(edit.splits, mesh.n_elements())};
  for (CutKnown* known : all_known(stroke)) {
    follow_hits(after, known->hit);
    follow_values(after, known->side);
    follow_opened(after, known->opened);
  }
  follow_hits(after, stroke.earlier_hit);
  follow_values(after, stroke.step);
  follow_values(after, stroke.whole_edge);
  for (auto* elements :
       {&stroke.fresh, &stroke.in_slit, &stroke.unfinished, &stroke.at_edge, &stroke.taken})
    *elements = after.numbers.all_after(*elements);
  follow_edge(after, stroke.edge);
}

}  // namespace trocar
