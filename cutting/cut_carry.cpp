// Material points by barycentric coordinates; edits between two frames are met by keeping the
// reference position.
#include "cutting/cut_carry.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/triangle.h"
#include "cutting/cut_patch.h"
#include "mesh/barycentric.h"
#include "mesh/element_boxes.h"
#include "mesh/facets.h"

namespace trocar {

// A point this far outside (barycentric) still counts as inside: rounding at facets.
static constexpr double outside_slack = 1e-9;
// A point outside goes with the element beside it up to this far (barycentric, heights):
// tissue that runs from the blade and comes back must not pass it uncut.
static constexpr double reach = 3.0;

// Of the element's point next to it, as good as: what lies outside is not strained with the
// element.
static std::array<double, 4> inside_of(std::array<double, 4> b) {
  double sum = 0;
  for (double& share : b) sum += share = std::max(share, 0.0);
  for (double& share : b) share /= sum;
  return b;
}

namespace {

// The best element so far for a point, and its least barycentric coordinate there.
struct Place {
  double most = -reach;
  BladePoint point;
};

}  // namespace

static void try_element(const Mesh& mesh, std::span<const Vec3> x, std::int32_t e, Place& place) {
  const std::array<double, 4> b = barycentric(mesh.corners(e), x, place.point.x);
  const double least = *std::min_element(b.begin(), b.end());
  if (!(least > place.most)) return;  // NaN of a flat one
  const std::array<double, 4> next = inside_of(b);
  place.most = least;
  place.point.element = e;
  place.point.is_inside = least >= -outside_slack;
  place.point.X = interpolate(mesh.corners(e), next, mesh.X);
  place.point.beyond = place.point.x - interpolate(mesh.corners(e), next, x);
}

// The first element of `near` that holds each point, else the nearest within `margin` [m].
static std::vector<Place> find_places(const Mesh& mesh, std::span<const Vec3> x,
                                      std::span<const std::int32_t> near,
                                      const std::vector<Vec3>& points, double margin) {
  std::vector<Place> places;
  for (const Vec3& point : points) places.push_back({.point = {.x = point}});
  Eigen::Index axis = 0;
  bounding_box(points).size().maxCoeff(&axis);
  std::vector<Place*> along;  // ascending along the axis
  for (Place& place : places) along.push_back(&place);
  const auto coordinate = [&](const Place* place) { return place->point.x[axis]; };
  std::ranges::sort(along, {}, coordinate);
  for (const std::int32_t e : near) {
    const Box box = element_box(mesh, e, x).grown(margin);  // rarely holds a point
    auto at = std::ranges::lower_bound(along, box.low[axis], {}, coordinate);
    for (; at != along.end() && coordinate(*at) <= box.high[axis]; ++at)
      if ((*at)->most < 0 && box.holds((*at)->point.x, 0)) try_element(mesh, x, e, **at);
  }
  return places;
}

// The edge's ends, and points a little beyond all along their ways from the begin of the sweep to
// its end: tissue there stays joined. An end that goes along the surface leaves none.
static std::vector<Vec3> ways_past_ends(const BladeSweep& sweep, double h) {
  constexpr double spacing = 0.25, most = 1000;  // over h; points
  std::vector<Vec3> points;
  const std::size_t last = sweep.after.size() - 1;
  for (const auto& [end, inner] : {std::pair{std::size_t{0}, std::size_t{1}}, {last, last - 1}}) {
    const Vec3 from = sweep.before[end], way = sweep.after[end] - from;
    const Vec3 past = beyond_end * h * (sweep.after[end] - sweep.after[inner]).normalized();
    const int n = h > 0 ? static_cast<int>(std::min(way.norm() / (spacing * h), most)) + 1 : 1;
    for (int k = 1; k <= n; ++k) points.push_back(from + way * (1.0 * k / n) + past);
    points.push_back(sweep.after[end]);
  }
  return points;
}

// Points that divide the pieces of a polyline into four.
static std::vector<Vec3> refined(const std::vector<Vec3>& line) {
  constexpr int parts = 4;
  std::vector<Vec3> points;
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
    for (int j = 0; j < parts; ++j)
      points.push_back(line[k] + (line[k + 1] - line[k]) * (1.0 * j / parts));
  points.push_back(line.back());
  return points;
}

static bool holds_some(const Mesh& mesh, std::span<const Vec3> x, std::int32_t e,
                       const std::vector<Vec3>& points) {
  const Box box = element_box(mesh, e, x);
  return std::ranges::any_of(points, [&](const Vec3& point) {
    return box.holds(point, 0) && std::ranges::min(barycentric(mesh.corners(e), x, point)) >= 0;
  });
}

// A point that leaves its way by more than 45 degrees is on a new one, if it is not just pushed
// aside. h: mean edge.
static void follow_way(const BladePoint& before, const Vec3& way, double h, BladePoint& now) {
  constexpr double pushed_aside = 0.5;  // h
  now.farthest = before.farthest - way;
  now.ahead = before.ahead;
  const double behind = now.ahead.dot(now.farthest);
  const double aside = (now.farthest - behind * now.ahead).norm();
  const bool is_on_way = aside < std::abs(behind);
  if (is_on_way && behind > 0) return;
  const double rest = is_on_way || now.ahead.isZero(0) ? same_place : pushed_aside;
  if (now.farthest.norm() <= rest * h) return;
  now.ahead = -now.farthest.normalized();
  now.farthest.setZero();
}

static void add_to_rim(const std::vector<Place>& places, CutStroke& stroke) {
  constexpr double least = 0.2;  // h
  const auto is_known = [&](const Vec3& X) {
    return std::ranges::any_of(
        stroke.rim, [&](const Vec3& R) { return (R - X).norm() <= least * stroke.mean_edge; });
  };
  for (const Place& place : places)
    if (place.point.is_inside && !is_known(place.point.X)) stroke.rim.push_back(place.point.X);
}

// Whether X lies within `depth` below the triangle, or a little beside it.
static bool is_below(const std::array<Vec3, 3>& triangle, const Vec3& X, double depth) {
  constexpr double slack = 0.1;  // barycentric
  const Vec3 n = area_normal(triangle);
  return std::abs(n.dot(X - triangle[0])) < depth * n.norm() && least_share(triangle, X) > -slack;
}

// Of the elements' facets those whose nodes all lie on the surface.
static std::vector<std::array<Vec3, 3>> surface_triangles(const Mesh& mesh, const CutIndex& index,
                                                          std::span<const std::int32_t> elements) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (const std::int32_t e : elements)
    for (int f = 0; f < 4; ++f) {
      std::array<Vec3, 3> X;
      bool is_outer = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const int corner = facet_corners(ElementType::tet4, f)[k];
        const std::int32_t i = mesh.corners(e)[corner];
        is_outer = is_outer && index.is_surface[i] != 0;
        X[k] = mesh.X[i];
      }
      if (is_outer) triangles.push_back(X);
    }
  return triangles;
}

// Where the edge begins inside. Where tissue comes towards the blade within the frame, by ways that
// are known between nodes only, it seems to hold an edge that was outside: right below the surface
// none begins.
static std::vector<Place> places_at_begin(const Mesh& mesh, const CutIndex& index,
                                          std::span<const Vec3> x, const BladeSweep& sweep,
                                          std::span<const std::int32_t> near, double h) {
  constexpr double depth = 0.25;  // h
  std::vector<Place> places = find_places(mesh, x, near, refined(sweep.before), h);
  std::erase_if(places, [](const Place& place) { return !place.point.is_inside; });
  if (places.empty()) return places;
  const std::vector<std::array<Vec3, 3>> surface = surface_triangles(mesh, index, near);
  std::erase_if(places, [&](const Place& place) {
    return std::ranges::any_of(surface, [&](const auto& triangle) {
      return is_below(triangle, place.point.X, depth * h);
    });
  });
  return places;
}

void remember_edge(const Mesh& mesh, const CutIndex& index, std::span<const Vec3> x,
                   const BladeSweep& sweep, std::span<const std::int32_t> near, CutStroke& stroke) {
  const double margin = stroke.mean_edge;
  add_to_rim(find_places(mesh, x, near, ways_past_ends(sweep, margin), margin), stroke);
  if (stroke.edge.empty()) add_to_rim(places_at_begin(mesh, index, x, sweep, near, margin), stroke);
  std::vector<Place> places = find_places(mesh, x, near, sweep.after, margin);
  for (std::size_t k = 0; k < std::min(places.size(), stroke.edge.size()); ++k)
    if (places[k].most < 0 && stroke.edge[k].element >= 0)
      try_element(mesh, x, stroke.edge[k].element, places[k]);
  for (std::size_t k = 0; k < places.size(); ++k)
    follow_way(k < stroke.edge.size() ? stroke.edge[k] : BladePoint{},
               sweep.after[k] - sweep.before[k], margin, places[k].point);
  stroke.edge.clear();
  for (const Place& place : places) stroke.edge.push_back(place.point);
  stroke.at_edge.clear();
  const std::vector<Vec3> points = refined(sweep.after);
  for (const std::int32_t e : near)
    if (holds_some(mesh, x, e, points)) stroke.at_edge.push_back(e);
}

bool is_remembered(const CutStroke& stroke, const BladeSweep& sweep) {
  const auto is_near = [](const BladePoint& p) { return p.element >= 0; };
  return stroke.edge.size() == sweep.before.size() && std::ranges::any_of(stroke.edge, is_near);
}

BladeSweep carry_edge(const Mesh& mesh, std::span<const Vec3> x, const BladeSweep& sweep,
                      const CutStroke& stroke) {
  BladeSweep carried = sweep;
  if (!is_remembered(stroke, sweep)) {
    for (std::size_t k = 0; k < sweep.tissue_way.size(); ++k)
      carried.before[k] += sweep.tissue_way[k];
    return carried;
  }
  std::vector<Vec3> way(stroke.edge.size(), Vec3::Zero());
  std::vector<std::size_t> inside;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const BladePoint& p = stroke.edge[k];
    if (p.element < 0) continue;
    const std::span<const std::int32_t> corner = mesh.corners(p.element);
    way[k] = interpolate(corner, barycentric(corner, mesh.X, p.X), x) + p.beyond - p.x;
    inside.push_back(k);
  }
  for (std::size_t k = 0; k < way.size(); ++k) {
    std::size_t nearest = 0, least = way.size();
    for (const std::size_t j : inside) {
      const std::size_t distance = j > k ? j - k : k - j;
      if (distance >= least) continue;
      least = distance;
      nearest = j;
    }
    carried.before[k] += way[nearest];
  }
  return carried;
}

}  // namespace trocar
