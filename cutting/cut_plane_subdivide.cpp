#include "cutting/cut_plane_subdivide.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "base/error.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr double off_corner = 1e-6;  // of an edge: a cut point never coincides with a corner

// The line of the cut: s is 0 at its start and 1 at its end.
struct Line {
  Vec3 from, along;

  double side(const Vec3& X) const { return cross_z(along, X - from); }
  double s(const Vec3& X) const { return along.dot(X - from) / along.squaredNorm(); }
};

using EdgeEnds = std::array<std::int32_t, 2>;

// A node on the line: its copies on the two sides, equal at an inner end of the cut.
struct CutPoint {
  Vec3 X;
  int n_triangles = 0;  // split ones that share the edge
  bool is_outer = false;
  std::int32_t left = -1, right = -1;
};

// A triangle that the cut splits; corner `lone` is alone on its side.
struct Crossed {
  std::int32_t element = 0;
  int lone = 0;
  bool is_lone_left = false;
};

EdgeEnds edge_of(std::span<const std::int32_t> corner, int k) {
  const auto [low, high] = std::minmax(corner[k % 3], corner[(k + 1) % 3]);
  return {low, high};
}

Vec3 crossing(const Mesh& mesh, const Line& line, const EdgeEnds& edge) {
  const Vec3 &a = mesh.X[edge[0]], &b = mesh.X[edge[1]];
  const double at_a = line.side(a), at_b = line.side(b);
  return a + std::clamp(at_a / (at_a - at_b), off_corner, 1 - off_corner) * (b - a);
}

// Corner alone on its side; -1 if all are on one side.
int lone_corner(const std::array<bool, 3>& is_left) {
  for (int k = 0; k < 3; ++k)
    if (is_left[k] != is_left[(k + 1) % 3] && is_left[k] != is_left[(k + 2) % 3]) return k;
  return -1;
}

std::vector<Crossed> crossed_triangles(const Mesh& mesh, const Line& line) {
  std::vector<Crossed> result;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> corner = mesh.corners(e);
    std::array<bool, 3> is_left{};
    for (int k = 0; k < 3; ++k) is_left[k] = line.side(mesh.X[corner[k]]) >= 0;
    const int lone = lone_corner(is_left);
    if (lone < 0) continue;
    const double p = line.s(crossing(mesh, line, edge_of(corner, lone)));
    const double q = line.s(crossing(mesh, line, edge_of(corner, lone + 2)));
    if (std::max(p, q) > 0 && std::min(p, q) < 1) result.push_back({e, lone, is_left[lone]});
  }
  return result;
}

std::map<EdgeEnds, CutPoint> make_cut_points(const Mesh& mesh, const Line& line,
                                             const std::vector<Crossed>& crossed) {
  const FacetNeighbours across = facet_neighbours(mesh);
  std::map<EdgeEnds, CutPoint> points;
  for (const Crossed& c : crossed)
    for (const int k : {c.lone, (c.lone + 2) % 3}) {
      const EdgeEnds edge = edge_of(mesh.corners(c.element), k);
      CutPoint& point = points[edge];
      point.X = crossing(mesh, line, edge);
      ++point.n_triangles;
      // Facet f lies opposite corner f, edge k opposite corner k + 2.
      point.is_outer = point.is_outer || across.of(c.element, (k + 2) % 3) < 0;
    }
  return points;
}

void add_nodes(std::map<EdgeEnds, CutPoint>& points, Mesh& mesh) {
  for (auto& [edge, point] : points) {
    point.left = point.right = mesh.n_nodes();
    mesh.X.push_back(point.X);
    const bool is_tip = point.n_triangles == 1 && !point.is_outer;
    if (is_tip) continue;
    point.right = mesh.n_nodes();
    mesh.X.push_back(point.X);
  }
}

struct SplitPart {
  std::array<std::int32_t, 3> corner;
  std::uint8_t cut_facets = 0;
};

// The lone corner's triangle and the two of the quadrilateral, halved by the diagonal that starts
// on the edge from corner 0 to 1 where that is cut, else on the edge from corner 2 to 0. `before`:
// facets of earlier cuts, by the element's corners.
std::array<SplitPart, 3> split(std::span<const std::int32_t> corner, const Crossed& c,
                               const CutPoint& p, const CutPoint& q, std::uint8_t before) {
  // Facet f lies opposite corner f.
  const auto old = [&](int beyond, int place) {
    const unsigned facet = before >> ((c.lone + beyond) % 3) & 1U;
    return static_cast<std::uint8_t>(facet << place);
  };
  const std::int32_t v = corner[c.lone], next = corner[(c.lone + 1) % 3],
                     last = corner[(c.lone + 2) % 3];
  const std::int32_t lone_p = c.is_lone_left ? p.left : p.right;
  const std::int32_t lone_q = c.is_lone_left ? q.left : q.right;
  const std::int32_t quad_p = c.is_lone_left ? p.right : p.left;
  const std::int32_t quad_q = c.is_lone_left ? q.right : q.left;
  constexpr std::uint8_t at_0 = 1U << 0, at_1 = 1U << 1;
  const auto mask = [](unsigned bits) { return static_cast<std::uint8_t>(bits); };
  const SplitPart tip{{v, lone_p, lone_q}, mask(at_0 | old(1, 1) | old(2, 2))};
  if (c.lone == 1)
    return {tip, SplitPart{{quad_p, next, quad_q}, mask(at_1 | old(2, 2))},
            SplitPart{{next, last, quad_q}, mask(old(1, 0) | old(0, 2))}};
  return {tip, SplitPart{{quad_p, next, last}, mask(old(0, 0) | old(2, 2))},
          SplitPart{{quad_p, last, quad_q}, mask(at_1 | old(1, 0))}};
}

}  // namespace

Mesh subdivide_along(const Mesh& mesh, const Vec3& a, const Vec3& b) {
  if (mesh.dimension() != 2) throw InputError("a cut by subdivision needs triangles (tri3) only");
  const Line line{a, b - a};
  const std::vector<Crossed> crossed = crossed_triangles(mesh, line);
  std::map<EdgeEnds, CutPoint> points = make_cut_points(mesh, line, crossed);
  Mesh result;
  result.X = mesh.X;
  add_nodes(points, result);
  auto next = crossed.begin();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> corner = mesh.corners(e);
    if (next == crossed.end() || next->element != e) {
      add_element(result, ElementType::tri3, corner);
      result.cut_facets.back() = mesh.cut_facets[e];
      continue;
    }
    const CutPoint& p = points.at(edge_of(corner, next->lone));
    const CutPoint& q = points.at(edge_of(corner, next->lone + 2));
    for (const SplitPart& t : split(corner, *next, p, q, mesh.cut_facets[e])) {
      add_element(result, ElementType::tri3, t.corner);
      result.cut_facets.back() = t.cut_facets;
    }
    ++next;
  }
  return result;
}

}  // namespace trocar
