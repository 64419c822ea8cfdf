#include "cutting/cut_plane_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trocar {

namespace {

constexpr double inside_slack = 1e-9;   // rounding, over an element's area
constexpr double on_boundary = 0.1;     // h
constexpr double least_length = 0.3;    // h
constexpr double tip_clearance = 0.4;   // h
constexpr double same_crossing = 1e-2;  // h
constexpr double held_clearance = 0.5;  // h
constexpr double look = 0.1;            // h, between two looks for held nodes

struct PathCrossing {
  double s = 0;
  PatchFacet facet;
};
struct PathCrossings {
  std::vector<PathCrossing> enter, leave;  // ascending s
};

std::size_t segment_at(const SubPath& path, double s) {
  const auto after = std::upper_bound(path.s.begin() + 1, path.s.end() - 1, s);
  return static_cast<std::size_t>(after - path.s.begin()) - 1;
}

bool is_inside(const PlanePatch& patch, const Vec2& p) {
  return element_at(patch, p, inside_slack) >= 0;
}

void cross_segment(const PlanePatch& patch, const SubPath& path, std::size_t k, PatchFacet facet,
                   PathCrossings& crossings) {
  const Vec2& a = patch.X[patch.corner[facet.element][(facet.facet + 1) % 3]];
  const Vec2& b = patch.X[patch.corner[facet.element][(facet.facet + 2) % 3]];
  const Vec2 &p = path.point[k], d = path.point[k + 1] - p;
  const std::optional<double> t = pass_between(p, d, a, b);
  if (!t || *t < -1e-9 || *t > 1 + 1e-9) return;
  const PathCrossing crossing{path.s[k] + *t * (path.s[k + 1] - path.s[k]), facet};
  const bool enters = cross(b - a, d) > 0;  // the inside is to the left of a -> b
  (enters ? crossings.enter : crossings.leave).push_back(crossing);
}

PathCrossings find_crossings(const PlanePatch& patch, const SubPath& path, int tip) {
  PathCrossings crossings;
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if (patch.across[e][f] != across_boundary) continue;
      const std::array<int, 3>& corner = patch.corner[e];
      if (tip >= 0 && (corner[(f + 1) % 3] == tip || corner[(f + 2) % 3] == tip)) continue;
      for (std::size_t k = 0; k + 1 < path.point.size(); ++k)
        cross_segment(patch, path, k, {e, f}, crossings);
    }
  const auto is_before = [](const PathCrossing& a, const PathCrossing& b) { return a.s < b.s; };
  std::stable_sort(crossings.enter.begin(), crossings.enter.end(), is_before);
  std::stable_sort(crossings.leave.begin(), crossings.leave.end(), is_before);
  return crossings;
}

const PathCrossing* first_after(const std::vector<PathCrossing>& crossings, double s) {
  for (const PathCrossing& crossing : crossings)
    if (crossing.s > s) return &crossing;
  return nullptr;
}

// Calls use(facet, way) for all facets of the boundary but those at `except`, with the shortest way
// from p to them.
template <class Use>
void for_boundary(const PlanePatch& patch, const Vec2& p, int except, const Use& use) {
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if (patch.across[e][f] != across_boundary) continue;
      const int i = patch.corner[e][(f + 1) % 3], j = patch.corner[e][(f + 2) % 3];
      if (i == except || j == except) continue;
      const Vec2 &a = patch.X[i], d = patch.X[j] - a;
      use(PatchFacet{e, f}, Vec2(a + share_to(a, d, p) * d - p));
    }
}

// Distance to the nearest boundary facet, which is returned; facets at `except` do not count.
double boundary_distance(const PlanePatch& patch, const Vec2& p, int except, PatchFacet& nearest) {
  double least = std::numeric_limits<double>::max();
  for_boundary(patch, p, except, [&](const PatchFacet& facet, const Vec2& way) {
    const double distance = way.norm();
    if (distance >= least) return;
    least = distance;
    nearest = facet;
  });
  return least;
}

// As boundary_distance; of the two lips of an older cut, which lie on each other, the facet is of
// the one through which `way` goes into the body.
double entered_distance(const PlanePatch& patch, const Vec2& p, const Vec2& way, int except,
                        PatchFacet& entered) {
  constexpr double clear = 0.1;  // sine of the angle between a facet and a way through it
  const double distance = boundary_distance(patch, p, except, entered);
  double least = distance + same_crossing * patch.h;
  for_boundary(patch, p, except, [&](const PatchFacet& facet, const Vec2& way_to) {
    const double d = way_to.norm();
    const std::array<int, 3>& corner = patch.corner[facet.element];
    const Vec2 along =
        patch.X[corner[(facet.facet + 2) % 3]] - patch.X[corner[(facet.facet + 1) % 3]];
    if (d >= least || cross(along, way) < clear * along.norm() * way.norm()) return;
    least = d;
    entered = facet;
  });
  return distance;
}

// Where the first piece begins; s < 0 if the path never meets the body.
PathCrossing find_start(const PlanePatch& patch, const SubPath& path, int tip,
                        const PathCrossings& crossings) {
  if (tip >= 0) return {0, {}};
  PathCrossing start{0, {}};
  const double distance = entered_distance(patch, path.point[0], tangent(path, 0), -1, start.facet);
  const double ahead = std::min(2 * on_boundary * patch.h, 0.5 * path.length());
  const bool is_on_boundary = distance < on_boundary * patch.h;
  if (is_on_boundary && is_inside(patch, position(path, ahead))) {
    for (const PathCrossing& enter : crossings.enter)  // from one lip to the other
      if (enter.s > same_crossing * patch.h && enter.s < ahead) start = enter;
    return start;
  }
  if (!is_on_boundary && is_inside(patch, path.point[0])) return {0, {}};
  const PathCrossing* enter = first_after(crossings.enter, is_on_boundary ? ahead : -1);
  return enter != nullptr ? *enter : PathCrossing{-1, {}};
}

PathCrossing find_end(const PlanePatch& patch, const SubPath& path, int tip) {
  PathCrossing end{path.length(), {}};
  PatchFacet nearest;
  const Vec2 back = -tangent(path, path.length());
  if (entered_distance(patch, path.point.back(), back, tip, nearest) < on_boundary * patch.h)
    end.facet = nearest;
  return end;
}

// How far an end at s may stay when it is moved towards the middle.
double cleared_end(const PlanePatch& patch, const SubPath& path, double s) {
  const double middle = 0.5 * path.length(), inward = s < middle ? 1 : -1;
  for (int step = 0; step < 10; ++step) {
    PatchFacet nearest;
    const double missing =
        tip_clearance * patch.h - boundary_distance(patch, position(path, s), path.tip, nearest);
    if (missing <= 1e-6 * patch.h || (middle - s) * inward <= 0) break;
    s += inward * missing;
  }
  return (middle - s) * inward < 0 ? middle - 0.5 * inward * middle : s;
}

// Whether an element at p has less than n_corners that are held; also where there is no element.
bool is_movable(const PlanePatch& patch, int n_corners, const Vec2& p) {
  bool is_found = false;
  for (int e = 0; e < patch.n_elements(); ++e) {
    const auto& [a, b, c] = patch.corner[e];
    if (!is_in_triangle(patch.X[a], patch.X[b], patch.X[c], p, inside_slack)) continue;
    if (patch.is_held[a] + patch.is_held[b] + patch.is_held[c] < n_corners) return true;
    is_found = true;
  }
  return !is_found;
}

// The stretch from `from` to `to`; its ends are inside the body where they are not the path's.
SubPath stretch(const SubPath& path, double from, double to) {
  SubPath result = trimmed(path, from, to);
  if (from > 0) {
    result.start_on = {};
    result.tip = -1;
  }
  if (to < path.length()) result.end_on = {};
  return result;
}

// Appends the stretches that can be cut to `result`, the middles of those that can't to `held`.
void add_movable(const PlanePatch& patch, int n_corners, const SubPath& path,
                 std::vector<SubPath>& result, std::vector<Vec2>& held) {
  const int n = static_cast<int>(std::ceil(path.length() / (look * patch.h)));
  const auto s = [&](int k) { return path.length() * k / n; };
  const auto is_free = [&](int k) { return is_movable(patch, n_corners, position(path, s(k))); };
  for (int first = 0; first <= n;) {
    int last = first;
    const bool is_cut = is_free(first);
    while (last < n && is_free(last + 1) == is_cut) ++last;
    if (!is_cut) held.push_back(position(path, 0.5 * (s(first) + s(last))));
    const double from = first > 0 ? s(first) + held_clearance * patch.h : 0;
    const double to = last < n ? s(last) - held_clearance * patch.h : path.length();
    if (is_cut && to - from > least_length * patch.h) result.push_back(stretch(path, from, to));
    first = last + 1;
  }
}

}  // namespace

SubPath make_sub_path(std::vector<Vec2> point) {
  SubPath path;
  path.point = std::move(point);
  path.s.assign(1, 0);
  for (std::size_t k = 1; k < path.point.size(); ++k)
    path.s.push_back(path.s.back() + (path.point[k] - path.point[k - 1]).norm());
  return path;
}

Vec2 position(const SubPath& path, double s) {
  const std::size_t k = segment_at(path, s);
  const double t = (s - path.s[k]) / (path.s[k + 1] - path.s[k]);
  return path.point[k] + t * (path.point[k + 1] - path.point[k]);
}

Vec2 tangent(const SubPath& path, double s) {
  const std::size_t k = segment_at(path, s);
  return (path.point[k + 1] - path.point[k]).normalized();
}

SubPath trimmed(const SubPath& path, double from, double to) {
  std::vector<Vec2> point{position(path, from)};
  const double least = 1e-9 * path.length();
  for (std::size_t k = 0; k < path.point.size(); ++k)
    if (path.s[k] > from + least && path.s[k] < to - least) point.push_back(path.point[k]);
  point.push_back(position(path, to));
  SubPath result = make_sub_path(std::move(point));
  result.start_on = path.start_on;
  result.end_on = path.end_on;
  result.tip = path.tip;
  return result;
}

double nearest_on(const SubPath& path, const Vec2& p) {
  double least = std::numeric_limits<double>::max(), s = 0;
  for (std::size_t k = 0; k + 1 < path.point.size(); ++k) {
    const Vec2 &a = path.point[k], d = path.point[k + 1] - a;
    const double t = share_to(a, d, p);
    const double distance = (p - a - t * d).norm();
    if (distance >= least) continue;
    least = distance;
    s = path.s[k] + t * d.norm();
  }
  return s;
}

double distance_to(const SubPath& path, const Vec2& p) {
  return (p - position(path, nearest_on(path, p))).norm();
}

SubPath with_ends(const SubPath& path, const Vec2& start, const Vec2& end, double reach) {
  const double from = start == path.point.front() ? 0 : reach;
  const double to = path.length() - (end == path.point.back() ? 0 : reach);
  SubPath result = trimmed(path, from, to);
  std::vector<Vec2> point = result.point;
  if (from > 0) point.insert(point.begin(), start);
  if (to < path.length()) point.push_back(end);
  const SubPath bent = make_sub_path(std::move(point));
  result.point = bent.point;
  result.s = bent.s;
  return result;
}

std::vector<Vec2> leave_out_held(const PlanePatch& patch, int n_corners,
                                 std::vector<SubPath>& paths) {
  if (std::ranges::find(patch.is_held, 1) == patch.is_held.end()) return {};  // not even a rim
  std::vector<SubPath> result;
  std::vector<Vec2> held;
  for (const SubPath& path : paths)
    if (patch.has_held)
      add_movable(patch, n_corners, path, result, held);
    else if (path.length() > least_length * patch.h)
      result.push_back(stretch(path, 0, path.length()));
  paths = std::move(result);
  return held;
}

void leave_out_near(const PlanePatch& patch, const Vec2& point, std::vector<SubPath>& paths) {
  const auto nearest =
      std::min_element(paths.begin(), paths.end(), [&](const SubPath& a, const SubPath& b) {
        return distance_to(a, point) < distance_to(b, point);
      });
  const SubPath path = *nearest;
  const double gap = 0.5 * patch.h, s = nearest_on(path, point);
  std::vector<SubPath> rest;
  if (s - gap > patch.h) rest.push_back(stretch(path, 0, s - gap));
  if (path.length() - s - gap > patch.h) rest.push_back(stretch(path, s + gap, path.length()));
  paths.insert(paths.erase(nearest), rest.begin(), rest.end());
}

void draw_back_ends(const PlanePatch& patch, SubPath& path) {
  const bool is_start_inside = path.start_on.element < 0 && path.tip < 0;
  const double from = is_start_inside ? cleared_end(patch, path, 0) : 0;
  const double to =
      path.end_on.element < 0 ? cleared_end(patch, path, path.length()) : path.length();
  path = trimmed(path, from, to);
}

bool has_room_ahead(const PlanePatch& patch, const SubPath& path, double room) {
  constexpr double ahead = 0.5;  // cosine
  if (path.end_on.element >= 0) return true;
  const Vec2 tangent_at_end = tangent(path, path.length());
  bool has_room = true;
  for_boundary(patch, path.point.back(), path.tip, [&](const PatchFacet&, const Vec2& way) {
    const double distance = way.norm();
    if (distance < room * patch.h && tangent_at_end.dot(way) > ahead * distance) has_room = false;
  });
  return has_room;
}

ClippedPath clip_to_body(const PlanePatch& patch, const SubPath& path, int tip) {
  ClippedPath result;
  const PathCrossings crossings = find_crossings(patch, path, tip);
  const double tolerance = same_crossing * patch.h;
  PathCrossing start = find_start(patch, path, tip, crossings);
  while (start.s >= 0 && start.s < path.length()) {
    const PathCrossing* leave = first_after(crossings.leave, start.s + tolerance);
    const PathCrossing end = leave != nullptr ? *leave : find_end(patch, path, tip);
    if (end.s - start.s > least_length * patch.h) {
      SubPath& piece = result.pieces.emplace_back(trimmed(path, start.s, end.s));
      piece.start_on = start.facet;
      piece.end_on = end.facet;
      piece.tip = start.s > 0 ? -1 : tip;
    } else if (leave == nullptr) {
      result.rest = start.s;
    } else if (end.s - start.s > on_boundary * patch.h) {
      result.left_out.push_back(0.5 * (start.s + end.s));
    }
    if (leave == nullptr) break;
    const PathCrossing* enter = first_after(crossings.enter, leave->s - tolerance);
    start = enter != nullptr ? *enter : PathCrossing{-1, {}};
  }
  return result;
}

}  // namespace trocar
