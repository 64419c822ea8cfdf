#include "engine/cut_along_tip.h"

#include "cutting/cut_plane_reaches.h"
#include "cutting/cut_plane_slit.h"
#include "engine/cut_record.h"
#include "engine/plane_tip.h"
#include "engine/simulation.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

constexpr double least_way = 1e-9;  // of a blade within a frame, else it rests [m]
// In mean edge lengths: what the paper's algorithm takes of a path at a time, and how near before a
// boundary a path that may grow waits until it goes through.
constexpr double plane_advance = 3.0, plane_room = 1.5;
constexpr double least_bridge = 0.1;  // mean edge lengths, as between two crossings

// In reference positions; a tip that has left the plane ends its path.
void take_up_tip(const Simulation& s, const BladeSweep& sweep, CutStage& stage) {
  std::vector<Vec3>& path = stage.plane_path;
  if (path.empty()) {
    const Location start = locate_nearest(s.mesh, s.cut_state.x, first_tip(sweep));
    path.push_back(interpolate(s.mesh, start, s.mesh.X));
  }
  if (sweep.after.front().z() != 0) return;
  const Location place = locate_nearest(s.mesh, s.cut_state.x, sweep.after.front());
  const Vec3 point = interpolate(s.mesh, place, s.mesh.X);
  if ((point - path.back()).norm() > least_way) path.push_back(point);
}

double path_length(const std::vector<Vec3>& path) {
  double length = 0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  return length;
}

// Along stage.plane_path, which then begins anew at the tip, or where its rest does. One that may
// grow is tried again where it is refused, and waits before a boundary until it is twice as long as
// it has to be.
void cut_reach(Simulation& s, CutStage& stage, bool may_grow, double h) {
  std::vector<Vec3>& path = stage.plane_path;
  const std::vector<std::uint8_t> is_held = held_nodes(s.holds, s.fixed);
  CutPlaneOptions options = stage.plane;
  if (may_grow && path_length(path) < 2 * plane_advance * h) options.room_ahead = plane_room;
  const CutConstraints constraints{is_held, s.loads.border, s.cut_state.x};
  const PlaneCut cut = cut_plane(s.mesh, path, stage.plane_tip, constraints, options);
  if (cut.edit.is_empty() && may_grow) return;
  note_edit(s, cut.edit, cut.figures, stage.strokes.back());
  if (!cut.rest.empty()) {
    stage.plane_tip = cut.tip;
    path = cut.rest;
    return;
  }
  // A cut that ends before its path does, at nodes that are held, is not continued.
  const auto X = [&](std::int32_t node) { return s.mesh.X[node]; };
  const bool is_continued = cut.tip >= 0 && (X(cut.tip) - path.back()).norm() < h;
  stage.plane_tip = is_continued ? cut.tip : -1;
  path = {is_continued ? X(cut.tip) : path.back()};
}

// Without what of it runs in a slit; the next reach begins there at the earliest.
void leave_slit(const Simulation& s, double h, CutStage& stage, std::vector<Vec3>& part) {
  const PathFromSlit rest = past_slit(s.mesh, part, stage.plane_tip, h);
  part = rest.point;
  stage.plane_path = {part.front()};
  stage.plane_tip = rest.tip;
}

// Takes the end of a path that runs in a slit from it, from where it enters the slit on.
std::vector<Vec3> take_end_in_slit(const Simulation& s, double h, const CutStage& stage,
                                   std::vector<Vec3>& part) {
  const Vec3 end = part.back();
  part = before_slit(s.mesh, {part, stage.plane_tip}, h);
  if (part.back() == end) return {};
  return {part.back(), end};
}

// Whether the blade has passed what is left there: into a slit or out of the body.
bool has_left_tissue(const Simulation& s, const std::vector<Vec3>& in_slit, const Vec3& end) {
  return !in_slit.empty() || locate_points(s.mesh, s.mesh.X, {&end, 1}).front().element < 0;
}

// What of a reach that ends in a slit was too short to be cut.
void note_bridge(Simulation& s, double h, CutStage& stage) {
  const std::vector<Vec3>& path = stage.plane_path;
  if (path_length(path) < least_bridge * h) return;
  const Vec3 middle = 0.5 * (path.front() + path.back());
  note_edit(s, {}, {.n_refused = 1, .refusals = {{middle, CutRefusal::no_room}}},
            stage.strokes.back());
}

}  // namespace

// Each reach is cut once it is long enough, enters a slit, leaves the body, or the next one begins.
// Other legs shorter than half an edge are left out: the next reach begins where they did.
void cut_along_tip(Simulation& s, CutStage& stage, const BladeSweep& sweep, bool is_last) {
  take_up_tip(s, sweep, stage);
  const double h = mean_edge_length(s.mesh);
  std::vector<std::vector<Vec3>> parts = reaches(stage.plane_path);
  for (std::vector<Vec3>& part : parts) {
    part.front() = stage.plane_path.front();
    leave_slit(s, h, stage, part);
    const std::vector<Vec3> in_slit = take_end_in_slit(s, h, stage, part);
    const bool may_grow = !is_last && &part == &parts.back() && in_slit.empty();
    const double length = path_length(part);
    if (length >= (may_grow ? plane_advance : 0.5) * h ||
        (!may_grow && length > 0 && has_left_tissue(s, in_slit, part.back()))) {
      stage.plane_path = part;
      cut_reach(s, stage, may_grow, h);
    } else if (may_grow) {
      stage.plane_path = part;
    }
    if (in_slit.empty()) continue;
    note_bridge(s, h, stage);
    stage.plane_path = in_slit;
    if (&part != &parts.back()) stage.plane_path = {in_slit.back()};
    stage.plane_tip = -1;
  }
}

}  // namespace trocar
