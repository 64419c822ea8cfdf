#include "engine/cut_stage.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/box.h"
#include "base/error.h"
#include "cutting/cut_plane_reaches.h"
#include "engine/apply_cut.h"
#include "engine/body_positions.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "engine/mesh_measures.h"
#include "engine/plane_tip.h"
#include "engine/simulation.h"
#include "engine/tissue_way.h"

namespace trocar {

namespace {

constexpr int idle_frames_to_leave =
    3;                              // a blade that touches nothing for so long has left the tissue
constexpr double least_way = 1e-9;  // of a blade within a frame, else it rests [m]
constexpr double tip_spacing = 0.25;  // of a plane blade's way, mean edge lengths
constexpr double plane_advance =
    3.0;  // mean edge lengths of the path that the paper's algorithm takes at a time

// Where the tissue has been within the frame, and how far it has come at most.
struct FrameTissue {
  Box box;
  double way = 0;  // [m]
};

FrameTissue tissue_in_frame(const Simulation& s) {
  FrameTissue tissue{.box = {}, .way = largest_surface_way(s)};
  for (const std::int32_t node : s.view.node)
    tissue.box.add(s.view.x[static_cast<std::size_t>(node)]);
  tissue.box.low.array() -= tissue.way;
  tissue.box.high.array() += tissue.way;
  return tissue;
}

// Of points within a frame's reach of a blade.
std::vector<Location> locate_beside(const Simulation& s, BodyPositions& positions,
                                    std::span<const Vec3> points) {
  const std::vector<std::int32_t> near = positions.elements_around(box_around(points));
  return locate_points(s.mesh, positions.x(), points, near);
}

bool is_one_inside(const Simulation& s, BodyPositions& positions, std::span<const Vec3> points) {
  return std::ranges::any_of(locate_beside(s, positions, points),
                             [](const Location& location) { return location.element >= 0; });
}

// Where the blade's edge is inside the tissue; for a plane body its tip alone, which is as long as
// the body is thick.
void locate_edge(const Simulation& s, BodyPositions& positions, std::span<const Vec3> edge,
                 CutStage& stage) {
  stage.engaged.clear();
  if (s.mesh.dimension() == 2) {
    const Location at = locate_beside(s, positions, edge.first(1))[0];
    if (at.element >= 0)
      stage.engaged.push_back({.middle = at, .length = s.scene.tissue.thickness});
    return;
  }
  const std::array<Vec3, 2> ends = {edge.front(), edge.back()};
  const std::vector<std::int32_t> near = positions.elements_around(box_around(ends));
  stage.engaged = locate_segment(s.mesh, positions.x(), ends, near);
}

// Whether the blade has met the tissue within the frame: beside where its edge is looked for, and
// between the frame's begin and its end, too.
bool has_met(const Simulation& s, BodyPositions& positions, const BladeSweep& sweep,
             CutStage& stage) {
  if (!stage.engaged.empty()) return true;
  if (s.mesh.dimension() == 3) return stage.tet.meets(s.mesh, positions, sweep);
  return is_one_inside(s, positions, way_of_tip(sweep, tip_spacing * s.edge_length));
}

void start_stroke(CutStage& stage, const Tool& tool, double time, std::int32_t dimension) {
  stage.is_in_stroke = true;
  stage.n_idle_frames = 0;
  stage.strokes.push_back({.tool = tool.name, .start = time});
  if (dimension == 3) stage.tet.start_stroke();
  stage.plane_tip = -1;
  stage.tissue_velocity.setZero();
}

// Whether the tissue goes on beyond an end of the edge.
bool goes_on_beside(const Simulation& s, BodyPositions& positions, const std::vector<Vec3>& edge) {
  return is_one_inside(s, positions, std::array<Vec3, 2>{edge.front(), edge.back()});
}

// Where the jaws of scissors begin to have tissue beside them: once a closing, as a rule.
void note_tissue_beside(Simulation& s, const CutStage& stage, double time, const BladeSweep& sweep,
                        BodyPositions& positions) {
  const Tool& tool = s.tools[static_cast<std::size_t>(stage.tool)];
  if (tool.kind != InstrumentKind::scissors || !goes_on_beside(s, positions, sweep.after)) return;
  if (stage.strokes.back().start < time && goes_on_beside(s, positions, sweep.before)) return;
  note_event(s, time,
             tool.name +
                 " leaves tissue uncut that lies beside its open jaws: a longer blade_length "
                 "opens wider, and further closings cut further");
}

void add_figures(const CutFigures& figures, bool has_edit, CutRecord& record) {
  record.n_refused += figures.n_refused;
  record.n_beside += figures.n_beside;
  record.refusals.insert(record.refusals.end(), figures.refusals.begin(), figures.refusals.end());
  if (!has_edit) return;
  const auto n_old = static_cast<double>(record.n_moved),
             n_new = static_cast<double>(figures.n_moved);
  if (n_old + n_new > 0)
    record.mean_deviation =
        (record.mean_deviation * n_old + figures.mean_deviation * n_new) / (n_old + n_new);
  ++record.n_edits;
  record.n_moved += figures.n_moved;
  record.n_duplicated += figures.n_duplicated;
  record.n_opened_facets += figures.n_opened_facets;
  record.n_turned += figures.n_turned;
  record.n_chips += figures.n_chips;
  record.n_pulled_back += figures.n_pulled_back;
  record.n_converted += figures.n_converted;
  record.n_kept_hexahedra += figures.n_kept_hexahedra;
  record.largest_deviation = std::max(record.largest_deviation, figures.largest_deviation);
  record.mean_edge = figures.mean_edge;
}

void note_edit(Simulation& s, const MeshEdit& edit, const CutFigures& figures, CutRecord& record) {
  add_figures(figures, !edit.is_empty(), record);
  if (edit.is_empty()) return;
  const std::int32_t n_before = s.mesh.n_elements(), n_pieces_before = s.n_pieces;
  apply_cut(s, edit, s.cut_state, record);
  if (s.n_pieces > n_pieces_before)
    note_event(s, record.end,
               record.tool + " frees a piece: the body is in " + std::to_string(s.n_pieces));
  const std::int64_t difference = s.mesh.n_elements() - n_before;
  record.n_elements_added += std::max<std::int64_t>(difference, 0);
  record.n_elements_dissolved += std::max<std::int64_t>(-difference, 0);
}

// Of a plane body's blade the tip alone.
BladeSweep sweep_of(const Simulation& s, const Tool& tool, const FrameSpan& span) {
  const auto edge_at = [&](double time) {
    std::vector<Vec3> edge = cutting_edge(tool, time);
    if (s.mesh.dimension() == 2) edge = {tip_in_plane(edge, s.scene.tissue.thickness)};
    return edge;
  };
  return {.before = edge_at(span.t0),
          .after = edge_at(span.t1),
          .normal = tool.path.at(0.5 * (span.t0 + span.t1)).rotation * Vec3::UnitY()};
}

// What a blade does within a frame.
struct BladeFrame {
  BladeSweep sweep;
  bool is_near = false;  // to the tissue, and cutting
};

BladeFrame frame_of_blade(Simulation& s, const FrameSpan& span, const FrameTissue& tissue,
                          const CutStage& stage, std::optional<BodyPositions>& positions) {
  const Tool& tool = s.tools[static_cast<std::size_t>(stage.tool)];
  BladeFrame frame{.sweep = sweep_of(s, tool, span)};
  Box blade;
  for (const Vec3& point : frame.sweep.after) blade.add(point);
  for (const Vec3& point : frame.sweep.before) blade.add(point);
  frame.is_near = blade.overlaps(tissue.box) && is_cutting(tool, span.t0, span.t1);
  if (!frame.is_near || tissue.way == 0) return frame;
  if (!positions) positions.emplace(s);
  frame.sweep.tissue_way = ways_beside(s, *positions, frame.sweep, tissue.way);
  return frame;
}

void cut_volume(Simulation& s, CutStage& stage, const BladeSweep& sweep, bool is_last,
                BodyPositions& positions) {
  CutFigures figures;
  const auto is_held = held_nodes(s.holds, s.fixed);
  const MeshEdit edit = stage.tet.advance(s.mesh, positions, is_held, sweep, is_last, figures);
  note_edit(s, edit, figures, stage.strokes.back());
}

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

double length_of(const std::vector<Vec3>& path) {
  double length = 0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  return length;
}

// Along stage.plane_path, which then begins anew at the tip, or where its rest does. One that may
// grow is tried again where it is refused.
void cut_reach(Simulation& s, CutStage& stage, bool may_grow, double h) {
  std::vector<Vec3>& path = stage.plane_path;
  const PlaneCut cut =
      cut_plane(s.mesh, path, stage.plane_tip, held_nodes(s.holds, s.fixed), stage.plane);
  if (cut.edit.is_empty() && may_grow) return;
  note_edit(s, cut.edit, cut.figures, stage.strokes.back());
  if (!cut.rest.empty()) {
    stage.plane_tip = cut.tip;
    path = cut.rest;
    return;
  }
  // A cut that ends before its path does, at nodes that are held, is not continued.
  const auto X = [&](std::int32_t node) { return s.mesh.X[static_cast<std::size_t>(node)]; };
  const bool is_continued = cut.tip >= 0 && (X(cut.tip) - path.back()).norm() < h;
  stage.plane_tip = is_continued ? cut.tip : -1;
  path = {is_continued ? X(cut.tip) : path.back()};
}

// Cuts the tip's path reach by reach, each once it is long enough or the next one begins. Legs
// shorter than half an edge are left out: the next reach begins where they did.
void cut_along_tip(Simulation& s, CutStage& stage, const BladeSweep& sweep, bool is_last) {
  take_up_tip(s, sweep, stage);
  const double h = mean_edge_length(s.mesh);
  std::vector<std::vector<Vec3>> parts = reaches(stage.plane_path);
  for (std::vector<Vec3>& part : parts) {
    const bool may_grow = !is_last && &part == &parts.back();
    part.front() = stage.plane_path.front();
    const double length = length_of(part);
    if (length >= (may_grow ? plane_advance : 0.5) * h) {
      stage.plane_path = part;
      cut_reach(s, stage, may_grow, h);
    } else if (may_grow) {
      stage.plane_path = part;
    }
  }
}

void end_stroke(CutStage& stage) {
  stage.is_in_stroke = false;
  stage.plane_path.clear();
}

void note_body(const Simulation& s, CutRecord& record) {
  record.n_pieces = s.n_pieces;
  record.scene_step_ratio = s.watch.stable_step / s.stable_step_before_cut;
}

Vec3 middle(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

Vec3 way_of_middle(const BladeSweep& sweep) {
  return middle(sweep.after) - middle(sweep.before);
}

// What sticks to the blade or springs back from it for a moment is not what it moves against: that
// is how the tissue came, and what it does in the long run.
void follow_tissue(const Simulation& s, double time, bool was_engaged, CutStage& stage) {
  constexpr double memory = 0.3;  // [s]
  if (stage.engaged.empty()) return;
  const double share = was_engaged ? time / (memory + time) : 1;
  stage.tissue_velocity += share * (velocity_along(s, stage.engaged) - stage.tissue_velocity);
}

// Whether a scalpel goes more than 60 degrees aside of where its edge faces, or backwards, as the
// tissue sees it; ways along the edge don't count.
bool is_askew(const Tool& tool, const FrameSpan& span, const BladeSweep& sweep,
              const CutStage& stage) {
  constexpr double facing = 0.5;
  if (tool.kind != InstrumentKind::scalpel) return false;
  const Mat3 frame = tool.path.at(0.5 * (span.t0 + span.t1)).rotation.toRotationMatrix();
  const Vec3 way = way_of_middle(sweep) - (span.t1 - span.t0) * stage.tissue_velocity;
  const Vec3 across = way - frame.col(2).dot(way) * frame.col(2);
  return across.norm() > least_way && frame.col(0).dot(across) < facing * across.norm();
}

// An edge cuts whichever way it moves: a robot's wrong turn about its shaft would not show.
void note_askew(Simulation& s, const CutRecord& record) {
  if (record.n_askew == 0 || 2 * record.n_askew < record.n_edits) return;
  note_event(s, record.end,
             record.tool +
                 " has cut with its edge turned by more than 60 degrees from its way in " +
                 std::to_string(record.n_askew) + " of " + std::to_string(record.n_edits) +
                 " edits: it cuts all the same, but a blade would not (`forward` in its path)");
}

// True if this is the edge's last frame in the tissue.
bool leaves_tissue(const Tool& tool, const FrameSpan& span, bool is_near, bool is_idle,
                   CutStage& stage) {
  stage.n_idle_frames = is_idle ? stage.n_idle_frames + 1 : 0;
  return !is_near || stage.n_idle_frames >= idle_frames_to_leave ||
         !is_cutting(tool, span.t1, span.t1 + (span.t1 - span.t0));
}

void add_to_record(double travel, double milliseconds, CutStage& stage) {
  CutRecord& record = stage.strokes.back();
  record.milliseconds += milliseconds;
  record.worst_milliseconds = std::max(record.worst_milliseconds, milliseconds);
  if (stage.engaged.empty()) return;
  record.blade_travel += travel;
  double length = 0;
  for (const SegmentPiece& piece : stage.engaged) length += piece.length;
  record.deepest = std::max(record.deepest, length);
}

// positions: none until a blade is near.
void cut_along_blade(Simulation& s, const FrameSpan& span, const BladeFrame& frame, CutStage& stage,
                     std::optional<BodyPositions>& positions) {
  const Tool& tool = s.tools[static_cast<std::size_t>(stage.tool)];
  const auto& [sweep, is_near] = frame;
  const bool was_engaged = stage.is_in_stroke && !stage.engaged.empty();
  stage.engaged.clear();
  if (!is_near && !stage.is_in_stroke) return;

  const double start = monotonic_seconds();
  if (!positions) positions.emplace(s);
  locate_edge(s, *positions, sweep.after, stage);
  const bool is_idle = !has_met(s, *positions, sweep, stage);
  if (!stage.is_in_stroke) {
    if (is_idle) return;
    s.stable_step_before_cut = s.watch.stable_step;
    start_stroke(stage, tool, span.t1, s.mesh.dimension());
  }
  follow_tissue(s, span.t1 - span.t0, was_engaged, stage);
  stage.strokes.back().end = span.t1;
  note_tissue_beside(s, stage, span.t1, sweep, *positions);
  const bool is_last = leaves_tissue(tool, span, is_near, is_idle, stage);
  const std::int64_t n_edits = stage.strokes.back().n_edits;
  if (s.mesh.dimension() == 2)
    cut_along_tip(s, stage, sweep, is_last);
  else
    cut_volume(s, stage, sweep, is_last, *positions);
  CutRecord& record = stage.strokes.back();
  if (record.n_edits > n_edits) {
    locate_edge(s, *positions, sweep.after, stage);
    if (is_askew(tool, span, sweep, stage)) record.n_askew += record.n_edits - n_edits;
  }
  add_to_record(way_of_middle(sweep).norm(), 1e3 * (monotonic_seconds() - start), stage);
  note_body(s, record);
  if (!is_last) return;
  note_askew(s, record);
  end_stroke(stage);
}

}  // namespace

void cut_along_blades(Simulation& s, const FrameSpan& span) {
  const PhaseScope scope(s.timers, phase_cut);
  const FrameTissue tissue = tissue_in_frame(s);
  std::optional<BodyPositions> positions;
  std::vector<BladeFrame> frames;  // all before the first edit: see ways_beside
  for (const CutStage& stage : s.cuts)
    frames.push_back(frame_of_blade(s, span, tissue, stage, positions));
  for (std::size_t k = 0; k < s.cuts.size(); ++k)
    cut_along_blade(s, span, frames[k], s.cuts[k], positions);
  if (const std::string trouble = find_trouble(s); !trouble.empty())
    throw SimulationError("after the cut at " + number_text(span.t1) + " s: " + trouble);
}

void prepare_drag(Simulation& s, const FrameSpan& span) {
  s.drag.node.clear();
  for (const CutStage& stage : s.cuts) {
    const Tool& tool = s.tools[static_cast<std::size_t>(stage.tool)];
    if (stage.engaged.empty() || !is_cutting(tool, span.t0, span.t1)) continue;
    add_engaged_edge({.tool = stage.tool,
                      .piece = stage.engaged,
                      .velocity = way_of_middle(sweep_of(s, tool, span)) / (span.t1 - span.t0),
                      .tissue_velocity = stage.tissue_velocity},
                     s.mesh, s.part, s.scene.cutting.resistance, s.drag);
  }
}

}  // namespace trocar
