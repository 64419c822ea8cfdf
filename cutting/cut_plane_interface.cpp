// Edges of interfaces that lie beside the path come first, then crossings of the others.
#include "cutting/cut_plane_interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/segment.h"

namespace trocar {

namespace {

constexpr double cos_bend = 0.8660254037844386;  // 30 degrees: nodes slide where it bends by less
constexpr double least_along = 0.5;    // of an edge's length, that the path goes beside it
constexpr double end_reach = 0.55;     // h: an end inside the body goes so far on to a node of an
                                       // interface that the path runs along …
constexpr double end_clearance = 0.4;  // h: … and else keeps so far away from interfaces
constexpr double end_look = 0.05;      // h, between two looks for that
constexpr double same_point = 1e-6;    // h

using Edge = std::array<int, 2>;

struct Stop {
  int node = 0;
  double s = 0;
  Vec2 target = Vec2::Zero();
  bool is_beside = false;  // the path has to bend there
};

struct Search {
  const PlanePatch& patch;
  const SubPath& path;
  SubPath reach;            // the path as far as its ends may go
  double before = 0;        // its length before the path [m]
  std::vector<Edge> edge;   // of interfaces
  std::vector<Edge> along;  // of these: the path runs beside it
  std::vector<Stop> stop;
};

std::vector<Edge> interface_edges(const PlanePatch& patch) {
  std::vector<Edge> edge;
  for_interface_edges(patch, [&](int i, int j) { edge.push_back({i, j}); });
  return edge;
}

bool is_free(const Search& search, int i) {
  return search.patch.is_boundary[i] == 0 && search.patch.is_held[i] == 0 && i != search.path.tip;
}

bool is_stop(const Search& search, int i) {
  return std::ranges::find(search.stop, i, &Stop::node) != search.stop.end();
}

// Whether the interface goes on straight at a node, so that it may slide there.
bool is_straight(const Search& search, int i) {
  std::vector<Vec2> way;
  for (const auto& [a, b] : search.edge)
    if (a == i || b == i) way.push_back(search.patch.X[a == i ? b : a] - search.patch.X[i]);
  return way.size() == 2 && -way[0].dot(way[1]) > cos_bend * way[0].norm() * way[1].norm();
}

void add_beside(Search& search, int i) {
  if (is_stop(search, i)) return;
  const Vec2& X = search.patch.X[i];
  search.stop.push_back({i, nearest_on(search.reach, X) - search.before, X, true});
}

// A path that begins or ends at a node was bent there: to a tip, or to where an interface ends.
bool is_at_end(const Search& search, int i) {
  const Vec2& X = search.patch.X[i];
  return X == search.path.point.front() || X == search.path.point.back();
}

// Not where only the end of the path is near.
bool is_beside(const Search& search, int i, double near) {
  if (is_at_end(search, i)) return true;
  const Vec2& X = search.patch.X[i];
  const double s = nearest_on(search.reach, X);
  return is_free(search, i) && s > 0 && s < search.reach.length() &&
         (position(search.reach, s) - X).norm() <= near;
}

bool is_along(const Search& search, const Edge& edge, double near) {
  const Vec2 &a = search.patch.X[edge[0]], &b = search.patch.X[edge[1]];
  const double way = std::abs(nearest_on(search.reach, a) - nearest_on(search.reach, b));
  return way >= least_along * (b - a).norm() && is_beside(search, edge[0], near) &&
         is_beside(search, edge[1], near);
}

void find_along(Search& search, double near) {
  for (const Edge& edge : search.edge) {
    if (!is_along(search, edge, near)) continue;
    search.along.push_back(edge);
    for (const int i : edge) add_beside(search, i);
  }
}

// The path crosses the edge at s: its nearer end goes there if the interface is straight, else the
// path bends to it.
void add_crossing(Search& search, Edge edge, double s) {
  const Vec2 p = position(search.path, s);
  if ((search.patch.X[edge[1]] - p).squaredNorm() < (search.patch.X[edge[0]] - p).squaredNorm())
    std::swap(edge[0], edge[1]);
  for (const bool slides : {true, false})
    for (const int i : edge) {
      if (!is_free(search, i) || is_stop(search, i) || is_straight(search, i) != slides) continue;
      if (slides)
        search.stop.push_back({i, s, p, false});
      else
        add_beside(search, i);
      return;
    }
}

void find_crossings(Search& search, const Edge& edge) {
  const PlanePatch& patch = search.patch;
  const SubPath& path = search.path;
  const Vec2 &a = patch.X[edge[0]], &b = patch.X[edge[1]];
  for (std::size_t k = 0; k + 1 < path.point.size(); ++k) {
    const std::optional<double> t =
        pass_between(path.point[k], path.point[k + 1] - path.point[k], a, b);
    if (t && *t >= 0 && *t < 1)
      add_crossing(search, edge, path.s[k] + *t * (path.s[k + 1] - path.s[k]));
  }
}

void find_all_crossings(Search& search) {
  const std::vector<Stop> beside = search.stop;
  const auto is_known = [&](int i) {
    return is_at_end(search, i) || std::ranges::find(beside, i, &Stop::node) != beside.end();
  };
  for (const Edge& edge : search.edge)
    if (!is_known(edge[0]) && !is_known(edge[1])) find_crossings(search, edge);
}

bool are_joined(const Search& search, int i, int j) {
  return std::ranges::any_of(search.along, [&](const Edge& edge) {
    return edge == Edge{i, j} || edge == Edge{j, i};
  });
}

// Points of a path, and which of them are stops.
struct Bending {
  std::vector<Vec2> point;
  std::vector<int> stop;  // (n_points) node; -1: none
};

void add_point(const Vec2& p, int stop, double same, Bending& bending) {
  if (!bending.point.empty() && (p - bending.point.back()).norm() <= same) {
    if (stop < 0) return;
    bending.point.pop_back();
    bending.stop.pop_back();
  }
  bending.point.push_back(p);
  bending.stop.push_back(stop);
}

// The path's own points between two arc lengths, from where it has come back from one bend to where
// it leaves for the next one.
void add_between(const Search& search, double from, double to, Bending& bending) {
  if (from >= to) return;
  for (const Vec2& p : trimmed(search.path, from, to).point)
    add_point(p, -1, same_point * search.patch.h, bending);
}

Bending bend(const Search& search, double from, double to) {
  const double reach = search.patch.h, same = same_point * search.patch.h;
  Bending bending;
  double behind = from;
  if (search.stop.empty() || search.stop.front().s > from)
    add_point(position(search.path, from), -1, same, bending);
  for (const Stop& stop : search.stop) {
    const double bent = stop.is_beside ? reach : 0;
    add_between(search, behind, stop.s - bent, bending);
    add_point(stop.target, stop.node, same, bending);
    behind = stop.s + bent;
  }
  add_between(search, behind, to, bending);
  if (search.stop.empty() || search.stop.back().s < to)
    add_point(position(search.path, to), -1, same, bending);
  return bending;
}

void extend(Search& search, bool at_start, bool at_end) {
  const SubPath& path = search.path;
  const double way = end_reach * search.patch.h;
  std::vector<Vec2> point = path.point;
  if (at_start) point.insert(point.begin(), point.front() - way * tangent(path, 0));
  if (at_end) point.push_back(point.back() + way * tangent(path, path.length()));
  search.reach = make_sub_path(std::move(point));
  search.before = at_start ? way : 0;
}

double interface_distance(const Search& search, const Vec2& p) {
  double least = std::numeric_limits<double>::max();
  for (const auto& [i, j] : search.edge) {
    const Vec2 foot = nearest_on_segment(search.patch.X[i], search.patch.X[j], p);
    least = std::min(least, (p - foot).norm());
  }
  return least;
}

// Where an end inside the body comes to lie on its way back to the last stop, or, without stops, to
// the middle: there, or at s, if it nowhere has room.
double free_end(const Search& search, double s, double limit) {
  const double h = search.patch.h, way = limit - s;
  const int n = static_cast<int>(std::ceil(std::abs(way) / (end_look * h)));
  for (int k = 0; k < n; ++k) {
    const double at = s + way * k / n;
    const bool is_within = at >= 0 && at <= search.path.length();
    if (is_within && interface_distance(search, position(search.path, at)) >= end_clearance * h)
      return at;
  }
  return search.stop.empty() ? s : limit;
}

}  // namespace

int region_at(const PlanePatch& patch, const Vec2& p) {
  const int e = element_at(patch, p, 0);
  return e >= 0 ? patch.region[e] : -1;
}

InterfaceRoute route_over_interfaces(const PlanePatch& patch, const SubPath& path, double near) {
  const bool has_free_start = path.start_on.element < 0 && path.tip < 0;
  const bool has_free_end = path.end_on.element < 0;
  Search search{patch, path, path, 0, interface_edges(patch), {}, {}};
  extend(search, has_free_start, has_free_end);
  find_along(search, near * patch.h);
  find_all_crossings(search);
  std::ranges::stable_sort(search.stop, {}, &Stop::s);
  double from = 0, to = path.length();
  if (has_free_start)
    from = free_end(search, 0, search.stop.empty() ? to / 2 : search.stop.front().s);
  if (has_free_end) to = free_end(search, to, search.stop.empty() ? to / 2 : search.stop.back().s);
  InterfaceRoute route{path, {}};
  const Bending bending = bend(search, from, to);
  if (bending.point.size() < 2) return route;
  const SubPath bent = make_sub_path(bending.point);
  route.path.point = bent.point;
  route.path.s = bent.s;
  for (std::size_t k = 0; k < bending.stop.size(); ++k)
    if (bending.stop[k] >= 0) route.stop.push_back({bending.stop[k], bent.s[k], false});
  for (std::size_t k = 0; k + 1 < route.stop.size(); ++k)
    route.stop[k].is_joined = are_joined(search, route.stop[k].node, route.stop[k + 1].node);
  return route;
}

}  // namespace trocar
