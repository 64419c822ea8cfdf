// Which nodes are displaced onto the cut.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cutting/cut_plane_chain.h"

namespace trocar {

namespace {

constexpr double band = 2.0;       // longest displacement considered, in h
constexpr double on_facet = 1e-9;  // rounding, in h

// The node of the facet that comes to the end of the path, which lies on the facet then: short of
// it, the node would dent the outline. A sharp corner stays where it is; if there is no other way
// the path bends into it.
int boundary_node(const PlanePatch& patch, PatchFacet facet, double at_corner, Vec2& end) {
  int near = patch.corner[facet.element][(facet.facet + 1) % 3];
  int far = patch.corner[facet.element][(facet.facet + 2) % 3];
  if ((patch.X[far] - end).squaredNorm() < (patch.X[near] - end).squaredNorm())
    std::swap(near, far);
  const bool is_at_corner = (patch.X[near] - end).norm() < at_corner * patch.h;
  if (is_at_corner && (patch.is_sharp[near] != 0 || patch.is_held[near] != 0)) {
    end = patch.X[near];
    return near;
  }
  const Vec2 along = patch.X[far] - patch.X[near];
  const Vec2 foot = patch.X[near] + share_to(patch.X[near], along, end) * along;
  for (const int i : {near, far})
    if (patch.is_held[i] == 0 && patch.is_sharp[i] == 0) {
      if ((foot - end).norm() > on_facet * patch.h) end = foot;
      return i;
    }
  for (const int i : {near, far})
    if (patch.is_held[i] == 0) {
      end = patch.X[i];
      return i;
    }
  return -1;
}

std::vector<int> candidates(const PlanePatch& patch, const SubPath& path,
                            const std::vector<std::uint8_t>& is_taken) {
  std::vector<int> result;
  for (int i = 0; i < patch.n_nodes(); ++i)
    if (patch.is_boundary[i] == 0 && patch.is_held[i] == 0 && is_taken[i] == 0 && i != path.tip &&
        (!patch.has_interfaces() || patch.is_interface[i] == 0) &&
        distance_to(path, patch.X[i]) < band * patch.h)
      result.push_back(i);
  return result;
}

// Of the region that the point lies in.
int nearest(const PlanePatch& patch, const std::vector<int>& among, const Vec2& p) {
  int best = -1;
  double least = std::numeric_limits<double>::max();
  const int region = patch.has_interfaces() ? region_at(patch, p) : -1;
  for (const int i : among) {
    if (region >= 0 && patch.region[patch.star[i]] != region) continue;
    const double distance = (patch.X[i] - p).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = i;
  }
  return best;
}

struct ChainEnds {
  int start = -1, end = -1;  // nodes given beforehand
};

// The paper's test: are the nearest nodes of n + 1 equally spaced points all different?
bool assign_nodes(const PlanePatch& patch, const std::vector<int>& among, const ChainEnds& ends,
                  int n, CutChain& chain) {
  chain.node.clear();
  chain.s.clear();
  for (int k = 0; k <= n; ++k) {
    const double s = chain.path.length() * k / n;
    const int given = k == 0 ? ends.start : k == n ? ends.end : -1;
    const int i = given >= 0 ? given : nearest(patch, among, position(chain.path, s));
    if (i < 0 || std::find(chain.node.begin(), chain.node.end(), i) != chain.node.end())
      return false;
    chain.node.push_back(i);
    chain.s.push_back(s);
  }
  return true;
}

// The same between one stop and the next one, with n segments over the whole length, as far as
// there is room for one between stops.
bool assign_between(const PlanePatch& patch, const std::vector<int>& among, const ChainEnds& ends,
                    int n, CutChain& chain) {
  const double length = chain.path.length();
  std::vector<InterfaceStop> stop = chain.stop;
  if (stop.front().s > 0) stop.insert(stop.begin(), {ends.start, 0, false});
  if (stop.back().s < length) stop.push_back({ends.end, length, false});
  chain.node.clear();
  chain.s.clear();
  const auto take = [&](int i, double s) {
    if (i < 0 || std::ranges::find(chain.node, i) != chain.node.end()) return false;
    chain.node.push_back(i);
    chain.s.push_back(s);
    return true;
  };
  for (std::size_t k = 0; k + 1 < stop.size(); ++k) {
    if (!take(stop[k].node, stop[k].s)) return false;
    const double way = stop[k + 1].s - stop[k].s;
    const int m = stop[k].is_joined ? 1 : static_cast<int>(std::lround(n * way / length));
    for (int j = 1; j < m; ++j) {
      const double s = stop[k].s + way * j / m;
      if (!take(nearest(patch, among, position(chain.path, s)), s)) return false;
    }
  }
  return take(stop.back().node, stop.back().s);
}

bool is_any_taken(const std::vector<InterfaceStop>& stop,
                  const std::vector<std::uint8_t>& is_taken) {
  return std::ranges::any_of(stop, [&](const InterfaceStop& s) { return is_taken[s.node] != 0; });
}

bool choose_ends(const PlanePatch& patch, const std::vector<std::uint8_t>& is_taken,
                 double at_corner, CutChain& chain, ChainEnds& ends) {
  ends.start = chain.path.tip;
  const SubPath& asked = chain.asked = chain.path;
  Vec2 start = ends.start >= 0 ? patch.X[ends.start] : asked.point.front();
  Vec2 end = asked.point.back();
  if (asked.start_on.element >= 0) {
    ends.start = boundary_node(patch, asked.start_on, at_corner, start);
    if (ends.start < 0 || is_taken[ends.start] != 0) return false;
  }
  if (asked.end_on.element >= 0) {
    ends.end = boundary_node(patch, asked.end_on, at_corner, end);
    if (ends.end < 0 || is_taken[ends.end] != 0 || ends.end == ends.start) return false;
  }
  chain.path = with_ends(asked, start, end, std::min(patch.h, asked.length() / 3));
  if (!patch.has_interfaces()) return true;
  InterfaceRoute route = route_over_interfaces(patch, chain.path, at_corner);
  chain.path = std::move(route.path);
  chain.stop = std::move(route.stop);
  return !is_any_taken(chain.stop, is_taken);
}

}  // namespace

int most_segments(const PlanePatch& patch, const SubPath& path) {
  return std::max(1, static_cast<int>(std::ceil(4 * path.length() / patch.least_edge)));
}

bool adapt_cut_points(const PlanePatch& patch, const AdaptOptions& options,
                      std::vector<std::uint8_t>& is_taken, CutChain& chain) {
  ChainEnds ends;
  if (!choose_ends(patch, is_taken, options.at_corner, chain, ends)) return false;
  const std::vector<int> among = candidates(patch, chain.path, is_taken);
  // Which nodes are nearest to the ends does not depend on the number of points.
  if (ends.start < 0) ends.start = nearest(patch, among, chain.path.point.front());
  if (ends.end < 0) ends.end = nearest(patch, among, chain.path.point.back());
  // More points than nodes can't have different nearest nodes.
  for (int n = std::min(options.most, static_cast<int>(among.size()) + 1); n >= 1; --n) {
    if (!(chain.stop.empty() ? assign_nodes(patch, among, ends, n, chain)
                             : assign_between(patch, among, ends, n, chain)))
      continue;
    for (const int i : chain.node) is_taken[i] = 1;
    return true;
  }
  return false;
}

}  // namespace trocar
