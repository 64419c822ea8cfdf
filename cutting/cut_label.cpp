// Minimum cut over the separated elements; uncut neighbours and elements of earlier advances are
// its terminals.
#include "cutting/cut_label.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/cut_flow.h"
#include "cutting/cut_neck.h"
#include "cutting/cut_slice.h"

namespace trocar {

// Corners this far from the surface (over h) on both sides: the surface passes between them.
static constexpr double clear_distance = 0.05;
// Keeps the cut from wandering where all distances are zero.
static constexpr double area_weight = 0.05;
// Whole-number capacities: this many units for one squared mean edge.
static constexpr double capacity_unit = 1e4;

double facet_cost(const CutSurroundings& around, std::int32_t e, int f) {
  const std::array<std::int32_t, 3> node = facet_nodes(around.patch, e, f);
  double cost = area_weight * facet_normal(around.patch, node).norm() / (around.h * around.h);
  for (const std::int32_t i : node) cost += around.surface_cost[i];
  return cost;
}

// Side that an uncut element has because the facet that it shares with a separated one lies there;
// 0 if that doesn't say.
static int implied_side(const ElementSides& sides, int f) {
  int plus = 0, minus = 0;
  for (const int c : tet_facets[f]) {
    plus += sides.corner[c] > 0 ? 1 : 0;
    minus += sides.corner[c] < 0 ? 1 : 0;
  }
  return (plus > 0 ? 1 : 0) - (minus > 0 ? 1 : 0);
}

// Distance of corner c of an element from the surface by the crossing points near it, else by those
// near another corner; 0 if there are none.
static double distance_at(const CutSurroundings& around, std::int32_t e, std::size_t c) {
  const std::array<std::int32_t, 4>& corner = around.patch.corner[e];
  std::span<const SurfacePoint> points = around.points.of(corner[c]);
  if (!points.empty()) return around.distance[corner[c]];
  for (std::size_t k = 0; k < 4 && points.empty(); ++k) points = around.points.of(corner[k]);
  const Vec3& X = around.patch.X[corner[c]];
  return points.empty() ? 0 : fit_surface(points, X, around.h).distance(X);
}

namespace {

// Least and largest distance of an element's corners from the surface, zero among them. [m]
struct Extent {
  double low = 0, high = 0;
  bool is_on_both_sides(double h) const {
    return high > clear_distance * h && low < -clear_distance * h;
  }
};

}  // namespace

static Extent extent_of(const CutSurroundings& around, const ElementSides& sides, std::int32_t e) {
  Extent extent;
  for (std::size_t c = 0; c < 4; ++c) {
    const double phi = sides.is_neutral[c] ? 0 : distance_at(around, e, c);
    extent.low = std::min(extent.low, phi);
    extent.high = std::max(extent.high, phi);
  }
  return extent;
}

// Side of an uncut element by the distances of its corners. If the surface is about to pass through
// it, it belongs to the front; if all its corners lie on the surface, the minimum cut decides.
static void set_geometric_side(const Extent& extent, double h, std::int32_t e, CutLabels& labels) {
  if (extent.is_on_both_sides(h))
    labels.kind[e] = labels.is_passed[e] == 0 ? CutKind::front : CutKind::separated;
  else if (extent.high == extent.low)
    labels.kind[e] = CutKind::separated;
  else
    labels.side[e] = extent.high >= -extent.low ? 1 : -1;
}

// Sides of the corners of elements that were crossed but not parted, by their distances: behind a
// blade that has passed, these are elements of which it left out an edge (tissue that moves
// from frame to frame slips past its edge).
static void part_front(const CutSurroundings& around, const CutLabels& labels,
                       std::vector<ElementSides>& sides) {
  for (std::int32_t e = 0; e < around.patch.n_elements(); ++e) {
    if (labels.is_passed[e] == 0 || sides[e].kind != CutKind::front) continue;
    sides[e].kind = CutKind::separated;
    for (std::size_t c = 0; c < 4; ++c) {
      const double phi = distance_at(around, e, c);
      const int side = (phi > 0 ? 1 : 0) - (phi < 0 ? 1 : 0);
      sides[e].corner[c] = static_cast<std::int8_t>(sides[e].is_neutral[c] ? 0 : side);
    }
  }
}

// Whether the minimum cut is to decide, or has not decided yet, on which side element e lies.
static bool is_unknown(const CutLabels& labels, std::int32_t e) {
  return labels.kind[e] == CutKind::separated && labels.side[e] == 0;
}

// Gives uncut neighbours of cut elements their side; one that the surface is about to pass through
// belongs to the front. An element with a side may have all its crossed edges at nodes that lie on
// the surface by now: neighbours to which it stayed joined, `unfinished`, are still such.
static void set_terminals(const CutSurroundings& around, const std::vector<ElementSides>& sides,
                          const std::vector<std::int32_t>& unfinished, CutLabels& labels) {
  const CutPatch& patch = around.patch;
  for (std::int32_t u = 0; u < patch.n_elements(); ++u) {
    if (labels.kind[u] != CutKind::uncut) continue;
    const auto& neutral = sides[u].is_neutral;
    // A whole facet on the surface: the fourth corner says where the element belongs.
    bool is_neighbour = std::count(neutral.begin(), neutral.end(), true) >= 3;
    bool is_plus = false, is_minus = false;
    const bool is_unfinished = std::ranges::binary_search(unfinished, patch.element[u]);
    for (int f = 0; f < 4; ++f) {
      const std::int32_t e = patch.across[u][f];
      if (e < 0) continue;
      const bool is_known = labels.kind[e] == CutKind::separated && labels.side[e] != 0;
      is_neighbour = is_neighbour || (is_unfinished && is_known);
      if (sides[e].kind != CutKind::separated) continue;
      is_neighbour = true;
      const int side = implied_side(sides[e], facet_towards(patch, e, u));
      is_plus = is_plus || side > 0;
      is_minus = is_minus || side < 0;
    }
    if (!is_neighbour) continue;
    if (is_plus != is_minus)
      labels.side[u] = is_plus ? 1 : -1;
    else
      set_geometric_side(extent_of(around, sides[u], u), around.h, u, labels);
  }
}

static void cut_graph(const CutSurroundings& around, CutLabels& labels) {
  const CutPatch& patch = around.patch;
  constexpr std::int32_t source = 0, sink = 1;
  std::vector<std::int32_t> vertex(patch.element.size(), -1);
  std::int32_t n_vertices = 2;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e) {
    if (is_unknown(labels, e))
      vertex[e] = n_vertices++;
    else if (labels.side[e] != 0 && labels.kind[e] != CutKind::front)
      vertex[e] = labels.side[e] > 0 ? source : sink;
  }
  std::vector<FlowArc> arcs;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 4; ++f) {
      const std::int32_t u = patch.across[e][f];
      if (u < e || vertex[e] < 0 || vertex[u] < 0 || vertex[e] == vertex[u] ||
          (vertex[e] <= sink && vertex[u] <= sink))
        continue;
      const double cost = facet_cost(around, e, f);
      arcs.push_back({vertex[e], vertex[u], 1 + std::llround(capacity_unit * cost)});
    }
  const std::vector<std::uint8_t> is_plus = minimum_cut(n_vertices, source, sink, arcs);
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    if (is_unknown(labels, e)) labels.side[e] = is_plus[vertex[e]] != 0 ? 1 : -1;
}

// Sides of the unknown elements: cuts again until no slice is parted at a neck, and none is lost.
static void decide_sides(const CutSurroundings& around, const CutStroke& stroke,
                         CutLabels& labels) {
  std::vector<std::int32_t> open;
  for (std::int32_t e = 0; e < around.patch.n_elements(); ++e)
    if (is_unknown(labels, e)) open.push_back(e);
  for (;;) {
    cut_graph(around, labels);
    std::vector<std::int32_t> joined = join_necks(around, open, labels);
    if (joined.empty()) joined = join_slices(around, stroke.parted_node, open, labels);
    if (joined.empty()) return;
    std::erase_if(open, [&](std::int32_t e) { return std::ranges::binary_search(joined, e); });
    for (const std::int32_t e : open) labels.side[e] = 0;
  }
}

// The elements without a side that a walk around edge (a, b) from element e into u, one of them,
// meets before it comes to the - side; empty if it doesn't.
static std::vector<std::int32_t> walk_around(const CutPatch& patch, const CutLabels& labels,
                                             std::int32_t a, std::int32_t b, std::int32_t e,
                                             std::int32_t u) {
  std::vector<std::int32_t> met;
  while (u >= 0 && labels.side[u] == 0) {
    met.push_back(u);
    const auto& corner = patch.corner[u];
    std::int32_t next = -1;
    for (std::size_t f = 0; f < 4; ++f)  // its facets at the edge: opposite to neither end
      if (corner[f] != a && corner[f] != b && patch.across[u][f] != e) next = patch.across[u][f];
    e = std::exchange(u, next);
  }
  return u >= 0 && labels.side[u] < 0 ? met : std::vector<std::int32_t>{};
}

// Elements without a side that hold both sides together around an edge.
static std::vector<std::int32_t> bridges(const CutPatch& patch, const CutLabels& labels) {
  std::vector<std::int32_t> found;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; labels.side[e] > 0 && f < 4; ++f) {
      const std::int32_t u = patch.across[e][f];
      if (u < 0 || labels.side[u] != 0) continue;
      const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<std::int32_t> met =
            walk_around(patch, labels, node[k], node[(k + 1) % 3], e, u);
        found.insert(found.end(), met.begin(), met.end());
      }
    }
  return found;
}

bool part_bridges(const CutSurroundings& around, const CutStroke& stroke, CutLabels& labels) {
  std::vector<std::int32_t> found = bridges(around.patch, labels);
  if (found.empty()) return false;
  const std::vector<ElementSides> sides = element_sides(around, stroke);
  const std::vector<const std::int8_t*> known = find_elements(stroke.side, around.patch.element);
  bool is_changed = false;
  for (;;) {
    bool is_going_on = false;
    for (const std::int32_t e : found) {
      const Extent extent = extent_of(around, sides[e], e);
      if (labels.is_passed[e] == 0 || is_unknown(labels, e) || extent.is_on_both_sides(around.h))
        continue;
      set_geometric_side(extent, around.h, e, labels);
      is_going_on = true;
    }
    if (!is_going_on) return is_changed;
    is_changed = true;
    for (std::int32_t e = 0; e < around.patch.n_elements(); ++e)
      if (known[e] == nullptr && labels.kind[e] == CutKind::separated) labels.side[e] = 0;
    decide_sides(around, stroke, labels);  // it knew too little of these before
    found = bridges(around.patch, labels);
  }
}

// A stroke that has gone through has passed everywhere. Another one ends at its rim, and where it
// ran in an older slit.
static std::vector<std::uint8_t> passed_elements(const CutSurroundings& around,
                                                 const CutStroke& stroke) {
  const CutPatch& patch = around.patch;
  std::vector<std::uint8_t> is_passed(patch.element.size(), 1);
  if (stroke.rim.empty()) return is_passed;
  std::vector<std::uint8_t> is_at_slit(patch.node.size(), 0);
  for (const std::int32_t element : stroke.in_slit)
    if (const std::int32_t e = patch.local_element(element); e >= 0)
      for (const std::int32_t i : patch.corner[e]) is_at_slit[i] = 1;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    if (!is_clear_of_rim(stroke, centre_of(patch, {&e, 1})) ||
        std::ranges::any_of(patch.corner[e], [&](std::int32_t i) { return is_at_slit[i] != 0; }))
      is_passed[e] = 0;
  return is_passed;
}

void leave_elements(const CutPatch& patch, std::span<const std::int32_t> element,
                    CutLabels& labels) {
  for (const std::int32_t e : element)
    for (const std::int32_t i : patch.corner[e]) labels.is_left[i] = 1;
}

CutLabels label_elements(const CutSurroundings& around, const CutStroke& stroke, bool is_last) {
  std::vector<ElementSides> sides = element_sides(around, stroke);
  const std::vector<const std::int8_t*> known = find_elements(stroke.side, around.patch.element);
  CutLabels labels;
  labels.is_passed = is_last && has_come_out(stroke)
                         ? passed_elements(around, stroke)
                         : std::vector<std::uint8_t>(around.patch.element.size(), 0);
  part_front(around, labels, sides);
  for (std::int32_t e = 0; e < around.patch.n_elements(); ++e) {
    labels.kind.push_back(known[e] != nullptr ? CutKind::separated : sides[e].kind);
    labels.side.push_back(known[e] != nullptr ? *known[e] : std::int8_t{0});
  }
  set_terminals(around, sides, stroke.unfinished, labels);
  decide_sides(around, stroke, labels);
  labels.is_left.assign(around.patch.node.size(), 0);
  labels.is_front_node.assign(around.patch.node.size(), 0);
  for (std::int32_t e = 0; e < around.patch.n_elements(); ++e)
    if (labels.kind[e] == CutKind::front ||
        std::binary_search(stroke.at_edge.begin(), stroke.at_edge.end(), around.patch.element[e]))
      for (const std::int32_t i : around.patch.corner[e]) labels.is_front_node[i] = 1;
  return labels;
}

}  // namespace trocar
