// Edge against triangle by signed volumes, taken in an order that neighbouring triangles share, so
// that no edge slips between them.
#include "cutting/cut_hits.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/sort_unique.h"
#include "cutting/cut_carry.h"
#include "cutting/cut_go_on.h"
#include "cutting/cut_in_slit.h"
#include "cutting/cut_near.h"
#include "mesh/node_corners.h"

namespace trocar {

// Part of the mean edge by which a band begins behind its begin.
static constexpr double overlap = 0.15;
// Part of the mean edge below which a way counts as rest. An edge that rests in tissue is left
// where it was remembered, so that slow ways add up and vibrations cut nothing.
static constexpr double least_way = 1e-3;

// The longest way of a point of the edge. [m]
static double sweep_length(const BladeSweep& sweep) {
  double longest = 0;
  for (std::size_t k = 0; k < sweep.before.size(); ++k)
    longest = std::max(longest, (sweep.after[k] - sweep.before[k]).norm());
  return longest;
}

namespace {

struct Band {
  struct Triangle {
    std::array<int, 3> point;
    Vec3 normal;  // unit, towards +
    Box box;
  };
  std::vector<Vec3> point;  // before 0, after 0, before 1, ...
  std::vector<Triangle> triangle;
  Box box;
};

struct Crossing {
  bool is_a_plus = false;
  double s = 0;  // from a to b
  Vec3 normal = Vec3::Zero();
};

// An edge a < b of the mesh as local edge of an element.
struct EdgeUse {
  std::int32_t a, b, element, edge;
  std::int64_t nodes() const { return std::int64_t{a} << 32 | b; }
  bool operator<(const EdgeUse& other) const {
    return nodes() != other.nodes() ? nodes() < other.nodes() : element < other.element;
  }
};

}  // namespace

static void add_triangle(Band& band, const std::array<int, 3>& point, const Vec3& side) {
  const Vec3 &p = band.point[point[0]], &q = band.point[point[1]], &r = band.point[point[2]];
  Vec3 normal = (q - p).cross(r - p);
  const double size = normal.norm();
  const double longest2 =
      std::max({(q - p).squaredNorm(), (r - p).squaredNorm(), (r - q).squaredNorm()});
  // A triangle without area sweeps nothing: a point of the edge that stands still.
  if (!(size > 1e-12 * longest2)) return;
  normal *= (normal.dot(side) < 0 ? -1 : 1) / size;
  band.triangle.push_back({point, normal, bounding_box(std::array{p, q, r})});
}

// Begins behind its begin by `back`, but no farther than the blade has been.
static Band make_band(const BladeSweep& sweep, double back, const CutStroke& stroke) {
  Band band;
  for (std::size_t k = 0; k < sweep.before.size(); ++k) {
    const Vec3 way = sweep.after[k] - sweep.before[k];
    const double length = way.norm();
    double longer = back;
    if (k < stroke.edge.size() && stroke.edge[k].ahead.dot(way) < 0)
      longer = std::clamp(stroke.edge[k].ahead.dot(stroke.edge[k].farthest), 0.0, back);
    band.point.push_back(length > 0 ? Vec3(sweep.before[k] - way * (longer / length))
                                    : sweep.before[k]);
    band.point.push_back(sweep.after[k]);
  }
  const int n = static_cast<int>(band.point.size());
  for (int k = 0; k + 3 < n; k += 2) {
    add_triangle(band, {k, k + 2, k + 3}, sweep.normal);
    add_triangle(band, {k, k + 3, k + 1}, sweep.normal);
  }
  for (const Band::Triangle& t : band.triangle) band.box.add(t.box);
  return band;
}

// Axes along and across the band: its box is as thin as the band is flat.
static OrientedBox box_of(const Band& band) {
  OrientedBox box;
  Vec3 normal = Vec3::Zero();
  for (const Band::Triangle& t : band.triangle) normal += t.normal;
  const Vec3 n = normal.norm() > 0.1 ? normal.normalized() : Vec3::UnitZ();
  Vec3 along = band.point.back() - band.point[1];  // the edge at the end
  along -= n * n.dot(along);
  const Vec3 u = along.norm() > 0 ? along.normalized() : n.unitOrthogonal();
  box.axes << n, u, n.cross(u);
  Box along_axes;
  for (const Vec3& p : band.point) along_axes.add(box.axes.transpose() * p);
  along_axes = along_axes.grown(1e-9 * along_axes.size().norm());
  box.low = along_axes.low;
  box.high = along_axes.high;
  return box;
}

static std::vector<EdgeUse> edge_uses(const Mesh& mesh, std::span<const std::int32_t> element) {
  std::vector<EdgeUse> use;
  use.reserve(element.size() * 6);
  for (const std::int32_t e : element)
    for (std::int32_t k = 0; k < 6; ++k) {
      const std::int32_t i = mesh.corners(e)[tet_edges[k][0]], j = mesh.corners(e)[tet_edges[k][1]];
      use.push_back({std::min(i, j), std::max(i, j), e, k});
    }
  std::sort(use.begin(), use.end());
  return use;
}

// Six times the signed volume of (a, b, p, q) with p and q in the order of their numbers; changes
// sign with their order.
static double side_of_line(const Band& band, const Vec3& a, const Vec3& b, int p, int q) {
  const Vec3 &low = band.point[std::min(p, q)], &high = band.point[std::max(p, q)];
  const double volume = (b - a).cross(low - a).dot(high - a);
  return p < q ? volume : -volume;
}

static bool passes_through(const Band& band, const Band::Triangle& t, const Vec3& a,
                           const Vec3& b) {
  const double u = side_of_line(band, a, b, t.point[0], t.point[1]);
  const double v = side_of_line(band, a, b, t.point[1], t.point[2]);
  const double w = side_of_line(band, a, b, t.point[2], t.point[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

// Net crossing of the band: an edge that goes through and back stays on its side.
static bool find_crossing(const Band& band, const Vec3& a, const Vec3& b, Crossing& crossing) {
  const Box box{a.cwiseMin(b), a.cwiseMax(b)};
  if (!band.box.overlaps(box)) return false;
  std::array<Crossing, 2> first;
  int net = 0;
  for (const Band::Triangle& t : band.triangle) {
    if (!t.box.overlaps(box)) continue;
    const Vec3& p = band.point[t.point[0]];
    const double phi_a = t.normal.dot(a - p), phi_b = t.normal.dot(b - p);
    if ((phi_a >= 0) == (phi_b >= 0) || !passes_through(band, t, a, b)) continue;
    const bool is_a_plus = phi_a >= 0;
    Crossing& known = first[is_a_plus ? 1 : 0];
    if (known.normal.isZero(0)) known = {is_a_plus, phi_a / (phi_a - phi_b), t.normal};
    net += is_a_plus ? 1 : -1;
  }
  crossing = first[net > 0 ? 1 : 0];
  return net != 0;
}

// n dx = (F^T n) dX.
static Vec3 reference_normal(const Mesh& mesh, std::span<const Vec3> x, std::int32_t e,
                             const Vec3& n) {
  const std::span<const std::int32_t> c = mesh.corners(e);
  Mat3 dX, dx;
  for (int k = 0; k < 3; ++k) {
    dX.col(k) = mesh.X[c[k + 1]] - mesh.X[c[0]];
    dx.col(k) = x[c[k + 1]] - x[c[0]];
  }
  const Vec3 N = dX.inverse().transpose() * (dx.transpose() * n);
  const double size = N.norm();
  return size > 0 && std::isfinite(size) ? Vec3(N / size) : n;
}

// An edge crossed again the same way keeps its first crossing; crossed back it has none.
static void merge_hits(std::vector<CutHit>& hit, std::vector<CutHit>& found) {
  const auto before = [](const CutHit& p, const CutHit& q) { return p.key() < q.key(); };
  std::sort(found.begin(), found.end(), before);
  std::vector<CutHit> merged;
  merged.reserve(hit.size() + found.size());
  auto old = hit.begin();
  for (const CutHit& next : found) {
    while (old != hit.end() && before(*old, next)) merged.push_back(*old++);
    const bool is_known = old != hit.end() && old->key() == next.key();
    if (!is_known)
      merged.push_back(next);
    else if (old->is_first_plus == next.is_first_plus)
      merged.push_back(*old);
    if (is_known) ++old;
  }
  merged.insert(merged.end(), old, hit.end());
  hit = std::move(merged);
}

// Whether an element's crossed edges part its corners.
static bool part_corners(std::span<const CutHit> hits) {
  unsigned crossed = 0, reached = 1;
  for (const CutHit& hit : hits) crossed |= 1U << hit.edge;
  for (int round = 0; round < 3; ++round)
    for (unsigned k = 0; k < 6; ++k) {
      const unsigned ends = 1U << tet_edges[k][0] | 1U << tet_edges[k][1];
      if ((crossed >> k & 1) == 0 && (reached & ends) != 0) reached |= ends;
    }
  return reached != 15;
}

// Whether elements hold the edge that it has begun to cross and not parted yet. Lips of older slits
// are no such: it crosses nothing there.
static bool is_edge_amid(const Mesh& mesh, const CutStroke& stroke) {
  const std::vector<std::span<const CutHit>> hits = hits_of(stroke, stroke.at_edge);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const std::int32_t e = stroke.at_edge[k];
    const std::uint8_t* own = find_element(stroke.opened, e);
    const bool is_older_lip = mesh.cut_facets[e] != (own != nullptr ? *own : 0);
    if (!hits[k].empty() && !part_corners(hits[k]) && !is_older_lip &&
        find_element(stroke.side, e) == nullptr)
      return true;
  }
  return false;
}

// Of tissue as it was before cuts split its elements.
static double mean_length(const Mesh& mesh, std::span<const std::int32_t> element,
                          const CutStroke& stroke) {
  double sum = 0;
  const std::vector<const double*> whole = find_elements(stroke.whole_edge, element);
  for (std::size_t k = 0; k < element.size(); ++k)
    sum += whole[k] != nullptr ? *whole[k] : tet_mean_edge(mesh, element[k]);
  return element.empty() ? 0 : sum / static_cast<double>(element.size());
}

// Where the band before this one ended in the tissue, if there was one.
static std::vector<std::int32_t> elements_at_edge(const CutStroke& stroke) {
  std::vector<std::int32_t> elements;
  for (const BladePoint& p : stroke.edge)
    if (p.element >= 0) elements.push_back(p.element);
  return elements;
}

// Edges `use` that the band crosses outside of older slits, for each of their elements; those of
// others, away from the slits' fronts, go to in_slit.
static std::vector<CutHit> find_hits(const Mesh& mesh, std::span<const Vec3> x, const Band& band,
                                     const std::vector<EdgeUse>& use, const OlderSlits& slits,
                                     std::vector<std::int32_t>& in_slit) {
  std::vector<CutHit> found;
  Crossing crossing;
  for (std::size_t begin = 0, end = 0; begin < use.size(); begin = end) {
    const std::int32_t a = use[begin].a, b = use[begin].b;
    while (end < use.size() && use[end].a == a && use[end].b == b) ++end;
    if (!find_crossing(band, x[a], x[b], crossing)) continue;
    const Vec3 X = mesh.X[a] + crossing.s * (mesh.X[b] - mesh.X[a]);
    const OlderSlits::Place place =
        slits.place_of(X, reference_normal(mesh, x, use[begin].element, crossing.normal));
    if (place == OlderSlits::Place::inside)
      for (std::size_t k = begin; k < end; ++k) in_slit.push_back(use[k].element);
    if (place != OlderSlits::Place::outside) continue;
    for (std::size_t k = begin; k < end; ++k) {
      const bool is_first_a = mesh.corners(use[k].element)[tet_edges[use[k].edge][0]] == a;
      found.push_back({use[k].element, use[k].edge, is_first_a == crossing.is_a_plus, X,
                       reference_normal(mesh, x, use[k].element, crossing.normal)});
    }
  }
  return found;
}

// Takes up what the band crosses of these elements.
static void cross_edges(const Mesh& mesh, std::span<const Vec3> x, const Band& band,
                        const std::vector<std::int32_t>& element, CutStroke& stroke) {
  const std::vector<EdgeUse> use = edge_uses(mesh, element);
  std::vector<CutHit> found =
      find_hits(mesh, x, band, use, {mesh, element, stroke, stroke.mean_edge}, stroke.in_slit);
  sort_unique(stroke.in_slit);
  if (found.empty()) return;
  stroke.mean_edge = mean_length(mesh, element, stroke);
  for (const CutHit& hit : found) stroke.fresh.push_back(hit.element);
  sort_unique(stroke.fresh);
  merge_hits(stroke.hit, found);
  take_up_left(mesh, found, stroke);
}

// Whether the band goes through the hexahedron, not just beside one of its faces.
static bool goes_through(const Mesh& mesh, std::span<const Vec3> x, const Band& band,
                         std::int32_t e) {
  constexpr double beside = 0.01;  // of an edge
  const std::span<const std::int32_t> c = mesh.corners(e);
  for (std::size_t a = 0; a < 4; ++a)
    for (const auto& [p, q] :
         {std::pair{a, (a + 1) % 4}, std::pair{a + 4, (a + 1) % 4 + 4}, std::pair{a, a + 4}}) {
      Crossing crossing;
      if (find_crossing(band, x[c[p]], x[c[q]], crossing) &&
          std::abs(crossing.s - 0.5) < 0.5 - beside)
        return true;
    }
  return false;
}

void add_hits(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
              const BladeSweep& sweep, CutStroke& stroke) {
  std::vector<std::int32_t> begin = elements_at_edge(stroke);
  positions.find(nodes_of(mesh, begin));
  const BladeSweep seen = carry_edge(mesh, positions.x(), sweep, stroke);
  const double way = sweep_length(seen);
  if (is_remembered(stroke, sweep) && way < least_way * stroke.mean_edge) {
    for (std::size_t k = 0; k < stroke.edge.size(); ++k) stroke.edge[k].x = sweep.after[k];
    return;
  }
  stroke.swept += way;
  const Band swept = make_band(seen, 0, stroke);
  // The first band of a stroke may begin anywhere.
  const bool is_first = stroke.edge.size() != sweep.before.size();
  if (is_first) begin = near_elements(mesh, index, positions, box_of(swept)).tets;
  if (stroke.mean_edge == 0)
    stroke.mean_edge = mean_length(
        mesh, is_first ? begin : near_elements(mesh, index, positions, box_of(swept), begin).tets,
        stroke);
  const std::span<const Vec3> x = positions.x();
  const Band band = make_band(seen, overlap * stroke.mean_edge, stroke);
  OrientedBox box = box_of(band);  // and tissue beyond the edge's ends
  box.low[1] -= 2 * beyond_end * stroke.mean_edge;
  box.high[1] += 2 * beyond_end * stroke.mean_edge;
  const NearElements near = near_elements(mesh, index, positions, box, begin);
  remember_edge(mesh, index, x, seen, near.tets, stroke);
  if (!band.triangle.empty()) {
    cross_edges(mesh, x, band, near.tets, stroke);
    for (const std::int32_t e : near.hexahedra)
      if (goes_through(mesh, x, band, e)) stroke.whole.push_back(e);
    sort_unique(stroke.whole);
  }
  if (goes_on(stroke)) stroke.is_amid = is_edge_amid(mesh, stroke);
}

}  // namespace trocar
