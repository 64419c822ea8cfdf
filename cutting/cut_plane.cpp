#include "cutting/cut_plane.h"

#include <algorithm>
#include <optional>

#include "base/check.h"
#include "base/error.h"
#include "base/sort_unique.h"
#include "cutting/cut_plane_chain.h"
#include "cutting/cut_plane_displace.h"
#include "cutting/cut_plane_edit.h"
#include "cutting/cut_plane_homogenise.h"
#include "cutting/cut_plane_patch.h"
#include "cutting/cut_plane_path.h"
#include "cutting/cut_plane_present.h"
#include "cutting/cut_plane_smooth.h"

namespace trocar {

namespace {

constexpr int max_attempts = 5;          // each with one segment less
constexpr double good_altitude = 0.5;    // least altitude after / before: no further attempt
constexpr double floor_altitude = 0.1;   // below this a cut is refused, whatever the step
constexpr int most_left_out = 12;        // stretches, then whole pieces are
constexpr double better_altitude = 1.5;  // worth a part of the cut that stays joined
constexpr double far_corner = 0.4;       // h: ends bend into corners so far away in later attempts

// The least step bound and the centre of the element that has it. [m]
struct Slowest {
  double bound = 0;
  Vec2 centre = Vec2::Zero();
};

// A try to lay all sub-paths into the patch.
struct Attempt {
  PlanePatch patch;
  std::vector<CutChain> chains;
  int bad_chain = -1;   // that could not be laid
  double altitude = 0;  // least altitude after / before; 0 if there is no valid mesh
  Slowest slowest;
  Crushed crushed;
};

std::vector<Vec2> plane_path(std::span<const Vec3> path) {
  std::vector<Vec2> result;
  for (const Vec3& point : path) {
    const Vec2 p(point.x(), point.y());
    if (result.empty() || (p - result.back()).norm() > 0) result.push_back(p);
  }
  return result;
}

void check_arguments(const Mesh& mesh, std::span<const Vec3> path,
                     const CutConstraints& constraints) {
  if (mesh.dimension() != 2)
    throw InputError("the plane cut needs a mesh of triangles (tri3) only");
  CHECK_OP(path.size(), >=, std::size_t{2});
  CHECK_OP(constraints.is_held.size(), ==, mesh.X.size());
}

double smallest_altitude(const PlanePatch& patch, const std::vector<Vec2>& x) {
  double least = 1e300;
  for (const auto& [a, b, c] : patch.corner)
    least = std::min(least, least_altitude(x[a], x[b], x[c]));
  return least;
}

Slowest find_slowest(const PlanePatch& patch, const std::vector<Vec2>& x) {
  Slowest slowest{1e300, {}};
  for (const auto& [a, b, c] : patch.corner)
    if (const double bound = step_bound(x[a], x[b], x[c]); bound < slowest.bound)
      slowest = {bound, (x[a] + x[b] + x[c]) / 3};
  return slowest;
}

bool keeps_floors(const Attempt& attempt, const CutPlaneOptions& options) {
  return attempt.altitude >= floor_altitude && attempt.slowest.bound >= options.least_step &&
         attempt.crushed.ratio >= least_present_ratio;
}

bool is_good(const Attempt& attempt, const CutPlaneOptions& options) {
  return keeps_floors(attempt, options) &&
         (!options.is_robust || attempt.altitude >= good_altitude);
}

bool is_better(const Attempt& a, const Attempt& b, const CutPlaneOptions& options) {
  const bool does_a = keeps_floors(a, options), does_b = keeps_floors(b, options);
  return does_a != does_b ? does_a : a.altitude > b.altitude;
}

std::vector<std::uint8_t> cut_nodes(const PlanePatch& patch, std::span<const CutChain> chains) {
  std::vector<std::uint8_t> result(patch.node.size(), 0);
  for (const CutChain& chain : chains)
    for (const int i : chain.node) result[i] = 1;
  return result;
}

// Index of the first chain that can't be laid; -1 if all can.
int lay_chains(Attempt& attempt, std::span<const AdaptOptions> adapt) {
  std::vector<std::uint8_t> is_taken(attempt.patch.node.size(), 0);
  for (int c = 0; c < static_cast<int>(attempt.chains.size()); ++c)
    if (!adapt_cut_points(attempt.patch, adapt[c], is_taken, attempt.chains[c])) return c;
  for (int c = 0; c < static_cast<int>(attempt.chains.size()); ++c)
    if (!recover_edges(attempt.patch, attempt.chains[c])) return c;
  return -1;
}

// As published: displaced neighbours, springs and particles, area step. The robust mode lets nodes
// slide along straight boundaries and flips edges for quality; its area step does most of the work,
// so that few steps of the particle system suffice.
bool remesh_around(Attempt& attempt, const CutPlaneOptions& options) {
  PlanePatch& patch = attempt.patch;
  const std::vector<std::uint8_t> is_cut = cut_nodes(patch, attempt.chains);
  const std::vector<Movable> movable =
      movable_nodes(patch, attempt.chains, options.rings, options.is_robust);
  if (!displace_onto_cut(patch, attempt.chains, movable, is_cut)) return false;
  homogenise(patch, movable, options);
  Smoothing smoothing = start_smoothing(patch, movable);
  for (int round = 0; round < 3 && options.is_robust; ++round) {
    area_step(patch, options.area_sweeps, smoothing);
    if (quality_flips(patch, is_cut, smoothing) == 0) break;
  }
  area_step(patch, options.area_sweeps, smoothing);
  return true;
}

// altitude 0: no valid mesh was found.
Attempt remesh(const PlanePatch& patch, std::span<const SubPath> sub_paths,
               std::span<const AdaptOptions> adapt, const CutPlaneOptions& options) {
  Attempt attempt{patch, {}, -1, 0};
  for (const SubPath& path : sub_paths) attempt.chains.push_back({path, {}, {}, {}, {}});
  attempt.bad_chain = lay_chains(attempt, adapt);
  if (attempt.bad_chain >= 0) return attempt;
  if (!remesh_around(attempt, options)) return attempt;
  attempt.crushed = pull_back(patch, cut_nodes(attempt.patch, attempt.chains), attempt.patch);
  attempt.altitude =
      smallest_altitude(attempt.patch, attempt.patch.x) / smallest_altitude(patch, patch.X);
  attempt.slowest = find_slowest(attempt.patch, attempt.patch.x);
  return attempt;
}

// With as many segments at first where ends lie on the boundary or the path beside an interface,
// which may then bend into corners and to that; else with one segment less.
AdaptOptions next_try(const PlanePatch& patch, const CutChain& chain, int attempt) {
  const bool is_bendable =
      chain.path.start_on.element >= 0 || chain.path.end_on.element >= 0 || patch.has_interfaces();
  const int fewer = attempt == 0 && is_bendable ? 0 : 1;
  return {chain.n_segments() - fewer, far_corner};
}

// Whether an end on the boundary has a node near that it bends into in later attempts.
bool is_near_corner(const PlanePatch& patch, PatchFacet on, const Vec2& end) {
  for (const int step : {1, 2}) {
    const int i = patch.corner[on.element][(on.facet + step) % 3];
    if ((patch.is_sharp[i] != 0 || patch.is_held[i] != 0) &&
        (patch.X[i] - end).norm() < far_corner * patch.h)
      return true;
  }
  return false;
}

// Whether the second attempt is the first one again: with as many segments, and nothing to bend to.
bool is_repeated(const PlanePatch& patch, const CutChain& chain) {
  const SubPath& asked = chain.asked;
  const bool is_start_on = asked.start_on.element >= 0, is_end_on = asked.end_on.element >= 0;
  return !patch.has_interfaces() && (is_start_on || is_end_on) &&
         !(is_start_on && is_near_corner(patch, asked.start_on, asked.point.front())) &&
         !(is_end_on && is_near_corner(patch, asked.end_on, asked.point.back()));
}

// The first good attempt, else the best one; each has one segment less, which gives the elements
// along the cut more room, and bends ends into corners from farther away.
Attempt best_attempt(const PlanePatch& patch, std::span<const SubPath> sub_paths,
                     const CutPlaneOptions& options) {
  std::vector<AdaptOptions> adapt;
  for (const SubPath& path : sub_paths) adapt.push_back({most_segments(patch, path), 0.1});
  Attempt best;
  for (int k = 0; k < max_attempts; ++k) {
    Attempt attempt = remesh(patch, sub_paths, adapt, options);
    if (attempt.bad_chain >= 0 && k == 0 && patch.has_interfaces()) {
      for (AdaptOptions& a : adapt) a.at_corner = far_corner;
      continue;
    }
    if (attempt.bad_chain >= 0) {
      if (best.altitude > 0) return best;
      const int c = attempt.bad_chain, n = attempt.chains[c].n_segments();
      if (n <= 1 || k + 1 == max_attempts) return attempt;
      adapt[c] = {n - 1, far_corner};
      continue;
    }
    if (k == 0 && std::ranges::all_of(attempt.chains, [&](const CutChain& chain) {
          return is_repeated(patch, chain);
        }))
      ++k;
    for (std::size_t c = 0; c < adapt.size(); ++c) adapt[c] = next_try(patch, attempt.chains[c], k);
    if (is_better(attempt, best, options)) best = std::move(attempt);
    if (is_good(best, options)) break;
  }
  return best;
}

struct Laid {
  Attempt attempt;
  std::vector<CutRefusal> refusals;
  double length = 0;  // of what is cut [m]
};

CutRefusal refusal_at(const Vec2& place, CutRefusal::Reason reason) {
  return {{place.x(), place.y(), 0}, reason};
}

// What a stretch of the path is in the way of, if that is known.
std::optional<CutRefusal> in_the_way(const Attempt& attempt, const CutPlaneOptions& options) {
  if (attempt.altitude <= 0) return {};
  if (attempt.crushed.ratio < least_present_ratio)
    return refusal_at(attempt.crushed.centre, CutRefusal::crushed);
  if (options.least_step == 0) return {};
  return refusal_at(attempt.slowest.centre, CutRefusal::slow);
}

// Stretches whose elements would be too small for the step or inverted, and pieces that can't be
// cut (slices at a corner, held nodes), are left joined, the others are cut; if it is not clear
// which piece is in the way, the shortest goes first.
void cut_what_is_possible(const PlanePatch& patch, std::vector<SubPath>& sub_paths,
                          const CutPlaneOptions& options, Laid& laid) {
  int n_left_out = 0;
  while (!sub_paths.empty()) {
    laid.attempt = best_attempt(patch, sub_paths, options);
    if (keeps_floors(laid.attempt, options)) return;
    if (const std::optional<CutRefusal> stretch = in_the_way(laid.attempt, options);
        stretch && n_left_out++ < most_left_out) {
      laid.refusals.push_back(*stretch);
      leave_out_near(patch, stretch->X.head<2>(), sub_paths);
      continue;
    }
    auto worst = std::min_element(
        sub_paths.begin(), sub_paths.end(),
        [](const SubPath& a, const SubPath& b) { return a.length() < b.length(); });
    if (laid.attempt.bad_chain >= 0) worst = sub_paths.begin() + laid.attempt.bad_chain;
    laid.refusals.push_back(
        refusal_at(position(*worst, 0.5 * worst->length()), CutRefusal::no_room));
    sub_paths.erase(worst);
  }
}

// Stretches through elements with n_held_corners or more stay joined.
Laid lay_beside_held(const PlanePatch& patch, std::vector<SubPath> sub_paths, int n_held_corners,
                     const CutPlaneOptions& options) {
  Laid laid;
  for (const Vec2& place : leave_out_held(patch, n_held_corners, sub_paths))
    laid.refusals.push_back(refusal_at(place, CutRefusal::held));
  if (options.is_robust)
    for (SubPath& sub_path : sub_paths) draw_back_ends(patch, sub_path);
  cut_what_is_possible(patch, sub_paths, options, laid);
  for (const SubPath& sub_path : sub_paths) laid.length += sub_path.length();
  return laid;
}

// Farther away from what is held more may be possible, or better elements.
Laid lay_as_possible(const PlanePatch& patch, const std::vector<SubPath>& sub_paths,
                     const CutPlaneOptions& options) {
  Laid laid = lay_beside_held(patch, sub_paths, 3, options);
  if (!patch.has_held || (laid.refusals.empty() && laid.attempt.altitude >= good_altitude))
    return laid;
  Laid farther = lay_beside_held(patch, sub_paths, 1, options);
  const bool has_better = farther.attempt.altitude > better_altitude * laid.attempt.altitude;
  return farther.length > laid.length || (farther.length > 0 && has_better) ? farther : laid;
}

std::vector<Vec3> end_of(const SubPath& path, double from) {
  std::vector<Vec3> points;
  for (const Vec2& point : trimmed(path, from, path.length()).point)
    points.emplace_back(point.x(), point.y(), 0);
  return points;
}

PlaneCut refused_at(const Vec2& place) {
  PlaneCut cut;
  cut.figures.n_refused = 1;
  cut.figures.refusals = {refusal_at(place, CutRefusal::no_room)};
  return cut;
}

}  // namespace

CutPlaneOptions published_options() {
  return {.is_robust = false, .most_steps = 150, .area_sweeps = 10};
}

double least_step_bound(const Mesh& mesh) {
  double least = 1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto corner = mesh.corners(e);
    const auto x = [&](int a) -> Vec2 { return mesh.X[corner[a]].head<2>(); };
    least = std::min(least, step_bound(x(0), x(1), x(2)));
  }
  return least;
}

PlaneCut cut_plane(const Mesh& mesh, std::span<const Vec3> path, std::int32_t continued_tip,
                   const CutConstraints& constraints, const CutPlaneOptions& options) {
  check_arguments(mesh, path, constraints);
  const std::vector<Vec2> point = plane_path(path);
  if (point.size() < 2) return refused_at(point.front());
  const PlanePatch patch = make_patch(mesh, point, constraints, options.rings + 1);
  if (patch.element.empty()) return {};
  const int tip = continued_tip >= 0 ? find_in(patch.node, continued_tip) : -1;
  const SubPath whole = make_sub_path(point);
  const ClippedPath clipped = clip_to_body(patch, whole, tip);
  if (clipped.pieces.empty() && clipped.rest < 0 && clipped.left_out.empty()) return {};
  if (clipped.pieces.empty()) return refused_at(position(whole, 0.5 * whole.length()));
  if (!has_room_ahead(patch, clipped.pieces.back(), options.room_ahead)) return {};
  CutPlaneOptions within = options;  // elements that lie below the floor may not sink further
  within.least_step = std::min(options.least_step, find_slowest(patch, patch.X).bound);
  const Laid laid = lay_as_possible(patch, clipped.pieces, within);
  PlaneCut cut;
  if (laid.length > 0) cut = make_plane_cut(mesh, patch, laid.attempt.patch, laid.attempt.chains);
  cut.figures.refusals = laid.refusals;
  for (const double s : clipped.left_out)
    cut.figures.refusals.push_back(refusal_at(position(whole, s), CutRefusal::no_room));
  cut.figures.n_refused = static_cast<std::int32_t>(cut.figures.refusals.size());
  if (clipped.rest < 0) return cut;
  cut.rest = end_of(whole, clipped.rest);
  cut.tip = -1;
  return cut;
}

}  // namespace trocar
