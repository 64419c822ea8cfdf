#include "cutting/cut_plane.h"

#include <algorithm>

#include "base/check.h"
#include "base/error.h"
#include "cutting/cut_plane_chain.h"
#include "cutting/cut_plane_displace.h"
#include "cutting/cut_plane_edit.h"
#include "cutting/cut_plane_homogenise.h"
#include "cutting/cut_plane_patch.h"
#include "cutting/cut_plane_path.h"
#include "cutting/cut_plane_smooth.h"

namespace trocar {

namespace {

constexpr int max_attempts = 5;          // each with one segment less
constexpr double good_altitude = 0.5;    // least altitude after / before: no further attempt
constexpr double floor_altitude = 0.1;   // below this a cut is refused
constexpr double better_altitude = 1.5;  // worth a part of the cut that stays joined
constexpr double far_corner = 0.4;       // h: ends bend into corners so far away in later attempts

// A try to lay all sub-paths into the patch.
struct Attempt {
  PlanePatch patch;
  std::vector<CutChain> chains;
  int bad_chain = -1;   // that could not be laid
  double altitude = 0;  // least altitude after / before; 0 if there is no valid mesh
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
                     std::span<const std::uint8_t> is_held) {
  if (mesh.dimension() != 2)
    throw InputError("the plane cut needs a mesh of triangles (tri3) only");
  CHECK_OP(path.size(), >=, std::size_t{2});
  CHECK_OP(is_held.size(), ==, mesh.X.size());
}

int local_node(const PlanePatch& patch, std::int32_t node) {
  const auto found = std::lower_bound(patch.node.begin(), patch.node.end(), node);
  const bool is_there = found != patch.node.end() && *found == node;
  return is_there ? static_cast<int>(found - patch.node.begin()) : -1;
}

double smallest_altitude(const PlanePatch& patch, const std::vector<Vec2>& x) {
  double least = 1e300;
  for (const auto& [a, b, c] : patch.corner)
    least = std::min(least, least_altitude(x[a], x[b], x[c]));
  return least;
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
  for (const SubPath& path : sub_paths) attempt.chains.push_back({path, {}, {}, {}});
  attempt.bad_chain = lay_chains(attempt, adapt);
  if (attempt.bad_chain >= 0) return attempt;
  if (remesh_around(attempt, options))
    attempt.altitude =
        smallest_altitude(attempt.patch, attempt.patch.x) / smallest_altitude(patch, patch.X);
  return attempt;
}

// Ends on the boundary first try the corners, all others one segment less.
AdaptOptions next_try(const CutChain& chain, int attempt) {
  const bool is_bendable = chain.path.start_on.element >= 0 || chain.path.end_on.element >= 0;
  const int fewer = attempt == 0 && is_bendable ? 0 : 1;
  return {chain.n_segments() - fewer, far_corner};
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
    if (attempt.bad_chain >= 0) return best.altitude > 0 ? best : attempt;
    for (std::size_t c = 0; c < adapt.size(); ++c) adapt[c] = next_try(attempt.chains[c], k);
    if (attempt.altitude > best.altitude) best = std::move(attempt);
    if (best.altitude >= (options.is_robust ? good_altitude : floor_altitude)) break;
  }
  return best;
}

// Pieces of the path that can't be cut (slices at a corner, held nodes) are left joined, the
// others are cut; if it is not clear which one is in the way, the shortest goes first.
Attempt cut_what_is_possible(const PlanePatch& patch, std::vector<SubPath>& sub_paths,
                             const CutPlaneOptions& options) {
  Attempt attempt;
  while (!sub_paths.empty()) {
    attempt = best_attempt(patch, sub_paths, options);
    if (attempt.altitude >= floor_altitude) break;
    auto worst = std::min_element(
        sub_paths.begin(), sub_paths.end(),
        [](const SubPath& a, const SubPath& b) { return a.length() < b.length(); });
    if (attempt.bad_chain >= 0) worst = sub_paths.begin() + attempt.bad_chain;
    sub_paths.erase(worst);
  }
  return attempt;
}

struct Laid {
  Attempt attempt;
  std::size_t n_refused = 0;
  double length = 0;  // of what is cut [m]
};

// Stretches through elements with n_held_corners or more stay joined.
Laid lay_beside_held(const PlanePatch& patch, std::vector<SubPath> sub_paths, int n_held_corners,
                     const CutPlaneOptions& options) {
  const int n_held = leave_out_held(patch, n_held_corners, sub_paths);
  if (options.is_robust)
    for (SubPath& sub_path : sub_paths) draw_back_ends(patch, sub_path);
  Laid laid;
  const std::size_t n_wanted = sub_paths.size() + static_cast<std::size_t>(n_held);
  laid.attempt = cut_what_is_possible(patch, sub_paths, options);
  laid.n_refused = n_wanted - sub_paths.size();
  for (const SubPath& sub_path : sub_paths) laid.length += sub_path.length();
  return laid;
}

// Farther away from what is held more may be possible, or better elements.
Laid lay_as_possible(const PlanePatch& patch, const std::vector<SubPath>& sub_paths,
                     const CutPlaneOptions& options) {
  Laid laid = lay_beside_held(patch, sub_paths, 3, options);
  if (!patch.has_held() || (laid.n_refused == 0 && laid.attempt.altitude >= good_altitude))
    return laid;
  Laid farther = lay_beside_held(patch, sub_paths, 1, options);
  const bool is_better = farther.attempt.altitude > better_altitude * laid.attempt.altitude;
  return farther.length > laid.length || (farther.length > 0 && is_better) ? farther : laid;
}

}  // namespace

CutPlaneOptions published_options() {
  return {.is_robust = false, .most_steps = 150, .area_sweeps = 10};
}

PlaneCut cut_plane(const Mesh& mesh, std::span<const Vec3> path, std::int32_t continued_tip,
                   std::span<const std::uint8_t> is_held, const CutPlaneOptions& options) {
  check_arguments(mesh, path, is_held);
  PlaneCut refused;
  refused.figures.n_refused = 1;
  const std::vector<Vec2> point = plane_path(path);
  if (point.size() < 2) return refused;
  const PlanePatch patch = make_patch(mesh, point, is_held, options.rings + 1);
  if (patch.element.empty()) return {};
  const int tip = continued_tip >= 0 ? local_node(patch, continued_tip) : -1;
  const std::vector<SubPath> sub_paths = clip_to_body(patch, make_sub_path(point), tip);
  if (sub_paths.empty()) return refused;
  const Laid laid = lay_as_possible(patch, sub_paths, options);
  PlaneCut cut;
  if (laid.length > 0) cut = make_plane_cut(mesh, patch, laid.attempt.patch, laid.attempt.chains);
  cut.figures.n_refused = static_cast<std::int32_t>(laid.n_refused);
  return cut;
}

}  // namespace trocar
