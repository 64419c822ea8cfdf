#include "engine/cut_stage.h"

#include <algorithm>
#include <optional>

#include "base/box.h"
#include "base/error.h"
#include "base/number_text.h"
#include "base/sort_unique.h"
#include "engine/cut_along_tip.h"
#include "engine/cut_look.h"
#include "engine/event_log.h"
#include "engine/frame_watch.h"
#include "engine/simulation.h"
#include "engine/tissue_way.h"
#include "engine/tool_report.h"

namespace trocar {

namespace {

// Where the tissue has been within the frame, and how far it has come at most.
struct FrameTissue {
  Box box;
  double way = 0;  // [m]
};

FrameTissue tissue_in_frame(const Simulation& s) {
  const double way = largest_surface_way(s);
  return {.box = box_of(s.view).grown(way), .way = way};
}

void start_stroke(CutStage& stage, const Tool& tool, double time) {
  stage.is_in_stroke = true;
  stage.n_idle_frames = 0;
  stage.strokes.push_back({.tool = tool.name, .start = time});
  stage.plane_tip = -1;
  if (!stage.knows_tissue) stage.tissue_velocity.setZero();
}

BladeSweep sweep_of(const Simulation& s, const Tool& tool, const FrameSpan& span) {
  return {.before = edge_in_body(s, tool, span.t0),
          .after = edge_in_body(s, tool, span.t1),
          .normal = tool.path.at(0.5 * (span.t0 + span.t1)).rotation * Vec3::UnitY()};
}

void end_stroke(CutStage& stage) {
  stage.is_in_stroke = false;
  stage.plane_path.clear();
  stage.swept.clear();
  stage.push = {};
}

void note_body(const Simulation& s, CutRecord& record) {
  record.n_pieces = s.n_pieces;
  record.scene_step_ratio = s.watch.stable_step / record.scene_step_before;
}

Vec3 way_of_middle(const BladeSweep& sweep) {
  return middle_of(sweep.after) - middle_of(sweep.before);
}

// What sticks to the blade or springs back from it for a moment is not what it moves against: that
// is how the tissue came, and what it does in the long run.
void follow_tissue(const Simulation& s, double time, bool was_engaged, const BladeLook& look,
                   CutStage& stage) {
  if (look.engaged.empty()) return;
  const double share = was_engaged || stage.knows_tissue ? share_of_frame(time) : 1;
  stage.tissue_velocity += share * (velocity_along(s, look.engaged) - stage.tissue_velocity);
}

// Of a frame in which the blade met resistance.
void add_to_push(const Simulation& s, const BladeWay& blade, CutStage& stage) {
  if (stage.resisted.empty()) return;
  const Vec3 way = way_of_middle(blade.sweep);
  const Vec3 of_tissue = (blade.span.t1 - blade.span.t0) * velocity_along(s, stage.resisted);
  const double size = way.norm();
  if (size == 0) return;
  stage.push.way += size;
  stage.push.along += std::clamp(of_tissue.dot(way) / size, 0.0, size);
}

// Whether a scalpel goes more than 60 degrees aside of where its edge faces, or backwards, and as
// the tissue sees it, too: that may be pushed aside by the blade. Ways along the edge don't count.
bool is_askew(const Simulation& s, const FrameSpan& span, const BladeSweep& sweep,
              const CutStage& stage) {
  constexpr double facing = 0.5;  // cosine
  const double rest = 1e-3 * s.edge_length;
  const Tool& tool = s.tools[stage.tool];
  if (tool.kind != InstrumentKind::scalpel) return false;
  const Mat3 frame = tool.path.at(0.5 * (span.t0 + span.t1)).rotation.toRotationMatrix();
  const auto is_aside = [&](const Vec3& way) {
    const Vec3 across = way - frame.col(2).dot(way) * frame.col(2);
    return across.norm() > rest && frame.col(0).dot(across) < facing * across.norm();
  };
  const Vec3 way = way_of_middle(sweep);
  return (way.norm() <= rest || is_aside(way)) &&
         is_aside(way - (span.t1 - span.t0) * stage.tissue_velocity);
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

void add_to_record(const BladeLook& look, const BladeSweep& sweep, double seconds,
                   CutRecord& record) {
  record.seconds += seconds;
  record.worst_seconds = std::max(record.worst_seconds, seconds);
  record.blade_travel += look.share_inside * way_of_middle(sweep).norm();
  record.deepest = std::max(record.deepest, look.most_inside);
}

BladeWay way_of_blade(Simulation& s, const FrameSpan& span, const FrameTissue& tissue,
                      const CutStage& stage, std::optional<double>& way) {
  const Tool& tool = s.tools[stage.tool];
  BladeWay blade{.span = span, .sweep = sweep_of(s, tool, span), .box = {}};
  BladeSweep& sweep = blade.sweep;
  for (const std::vector<Vec3>* edge : {&sweep.before, &sweep.after})
    for (const Vec3& point : *edge) blade.box.add(point);
  blade.is_near = blade.box.overlaps(tissue.box) && is_cutting(tool, span.t0, span.t1);
  if (!blade.is_near || tissue.way == 0) return blade;
  AroundBlade around(s, blade.box, stage, way);
  sweep.tissue_way = found_by<std::vector<Vec3>>(
      around.group, [&] { return ways_beside(s, around.positions, sweep, tissue.way); });
  for (std::size_t k = 0; k < sweep.tissue_way.size(); ++k)
    blade.box.add(sweep.before[k] + sweep.tissue_way[k]);
  return blade;
}

// Once a closing: tissue that swings goes in and out between the jaws.
void note_beside(Simulation& s, double time, const Tool& tool, CutStage& stage) {
  if (stage.has_told_beside) return;
  stage.has_told_beside = true;
  note_event(s, time,
             tool.name +
                 " leaves tissue uncut that lies beside its open jaws: a longer blade_length "
                 "opens wider, and further closings cut further");
}

// Whether nodes were put on edges, and the cut itself is still to come.
bool is_unfinished(const BladeLook& look) {
  return !look.edit.inserted.empty();
}

// Tissue that hangs by a stretched neck may spring farther than moved nodes can follow.
void note_energy_change(Simulation& s, const CutRecord& record) {
  constexpr double quiet = 0.15;
  if (record.strain_energy_change > quiet)
    note_event(s, record.end,
               record.tool + ": an edit has changed the strain energy around it by " +
                   short_text(100 * record.strain_energy_change) +
                   " % (strain_energy_change): tissue was stretched far there; a finer mesh or a "
                   "slower pull helps");
}

// A floor under the stable step, supports and sharp edges keep nodes off the blade's way.
void note_deviation(Simulation& s, const CutRecord& record) {
  constexpr double far = 0.25;  // edges
  if (record.figures.mean_deviation() > far * record.figures.mean_edge)
    note_event(
        s, record.end,
        record.tool + "'s cut lies " + short_text(1e3 * record.figures.mean_deviation()) +
            " mm beside its way in the mean, of edges of " +
            short_text(1e3 * record.figures.mean_edge) +
            " mm (deviation_mean_m): a lower cutting.least_step_ratio or a finer mesh helps");
}

// Elements of which the edge went through a part alone stay whole, as do those around an end of the
// cut: of a shallow one that may be all.
void note_swept_area(Simulation& s, std::span<const SweptPlace> swept, CutRecord& record) {
  constexpr double little = 1.0 / 3, enough = 4;  // of the swept area; edges squared
  const SweptArea area = measure_swept(s.mesh, s.edge_length, swept);
  record.swept_area = area.whole;
  record.parted_area = area.parted;
  if (record.figures.n_opened_facets == 0 || area.parted > little * area.whole ||
      area.whole < enough * s.edge_length * s.edge_length)
    return;
  note_event(s, record.end,
             record.tool + " has parted " + short_text(1e4 * area.parted) + " of the " +
                 short_text(1e4 * area.whole) + " cm^2 that its edge went through, at most " +
                 short_text(1e3 * record.deepest) + " mm deep: elements, whose edges have " +
                 short_text(1e3 * s.edge_length) +
                 " mm, stay whole where it goes through a part of them; a finer mesh helps, or a "
                 "deeper cut");
}

// At its end.
void note_stroke(Simulation& s, std::span<const SweptPlace> swept, CutRecord& record) {
  note_askew(s, record);
  note_refusals(s, record);
  if (s.mesh.dimension() == 3) note_swept_area(s, swept, record);
  note_deviation(s, record);
  note_energy_change(s, record);
}

// What the group's cutters have made, on all ranks.
void take_over(Simulation& s, const CutGroup& group, const BladeLook& look, CutStage& stage) {
  stage.keepers = group.is_everyone() ? std::vector<int>() : group.ranks();
  if (!look.edit.is_empty())
    for (CutStage& other : s.cuts)
      if (&other != &stage || !group.has_this_rank()) other.tet.follow(s.mesh, look.edit);
  if (look.is_last && !is_unfinished(look))
    for (CutStage& other : s.cuts)
      if (&other != &stage) other.tet.take_over(look.left);
  note_edit(s, look.edit, look.figures, stage.strokes.back());
}

// What follows nodes on edges, the blade at rest.
void finish_cut(Simulation& s, const BladeWay& blade, std::optional<double>& way, CutStage& stage,
                BladeLook look) {
  const BladeSweep rest{
      .before = blade.sweep.after, .after = blade.sweep.after, .normal = blade.sweep.normal};
  while (is_unfinished(look)) {
    AroundBlade around(s, blade.box, stage, way);
    bring_stroke(s, around.group.ranks(), stage);
    look = found_by<BladeLook>(around.group, [&] {
      BladeLook next{.is_last = look.is_last};
      advance_stroke(s, rest, stage, around.positions, next);
      return next;
    });
    take_over(s, around.group, look, stage);
  }
}

// After an edit.
void locate_edge_anew(Simulation& s, const BladeWay& blade, std::optional<double>& way,
                      CutStage& stage) {
  AroundBlade around(s, blade.box, stage, way);
  stage.is_engaged = !found_by<std::vector<SegmentPiece>>(around.group, [&] {
                        return locate_edge(s, around.positions, blade.sweep.after);
                      }).empty();
}

// Whether the blade is in a stroke then.
bool take_up_stroke(Simulation& s, const BladeWay& blade, const BladeLook& look, CutStage& stage) {
  const Tool& tool = s.tools[stage.tool];
  stage.is_engaged = !look.engaged.empty();
  if (!stage.is_in_stroke) {
    if (!look.has_met) return false;
    start_stroke(stage, tool, blade.span.t1);
    stage.strokes.back().scene_step_before = s.watch.stable_step;
  }
  stage.n_idle_frames = look.has_met ? 0 : stage.n_idle_frames + 1;
  stage.strokes.back().end = blade.span.t1;
  stage.swept.insert(stage.swept.end(), look.swept.begin(), look.swept.end());
  if (look.is_beside) note_beside(s, blade.span.t1, tool, stage);
  return true;
}

void cut_along_blade(Simulation& s, const BladeWay& blade, CutStage& stage,
                     std::optional<double>& way) {
  const FrameSpan& span = blade.span;
  stage.knows_tissue = stage.beside.has_value();
  if (stage.beside) stage.tissue_velocity = *stage.beside;
  const bool was_engaged = stage.is_in_stroke && stage.is_engaged;
  stage.is_engaged = false;
  const Tool& tool = s.tools[stage.tool];
  stage.has_told_beside = stage.has_told_beside && is_cutting(tool, span.t0, span.t1);
  if (!blade.is_near && !stage.is_in_stroke) return;

  const double start = monotonic_seconds();
  AroundBlade around(s, blade.box, stage, way);
  bring_stroke(s, around.group.ranks(), stage);
  const auto look = found_by<BladeLook>(
      around.group, [&] { return look_and_cut(s, blade, was_engaged, stage, around.positions); });
  if (!take_up_stroke(s, blade, look, stage)) return;
  follow_tissue(s, span.t1 - span.t0, was_engaged, look, stage);
  const std::int64_t n_edits = stage.strokes.back().n_edits;
  if (s.mesh.dimension() == 2)
    cut_along_tip(s, stage, blade.sweep, look.is_last);
  else
    take_over(s, around.group, look, stage);
  if (is_unfinished(look)) finish_cut(s, blade, way, stage, look);
  CutRecord& record = stage.strokes.back();
  record.n_ranks = std::max<std::int64_t>(record.n_ranks, std::ssize(around.group.ranks()));
  if (record.n_edits > n_edits) {
    locate_edge_anew(s, blade, way, stage);
    // Back in its slit it opens what it parted ahead.
    if (look.goes_on && is_askew(s, span, blade.sweep, stage))
      record.n_askew += record.n_edits - n_edits;
  }
  add_to_record(look, blade.sweep, monotonic_seconds() - start, record);
  record.push = stage.push;
  note_body(s, record);
  if (!look.is_last) return;
  note_stroke(s, stage.swept, record);
  end_stroke(stage);
}

}  // namespace

void cut_along_blades(Simulation& s, const FrameSpan& span) {
  const PhaseScope scope(s.timers, phase_cut);
  const FrameTissue tissue = tissue_in_frame(s);
  std::optional<double> way;
  std::vector<BladeWay> blades;  // all before the first edit: see ways_beside
  for (const CutStage& stage : s.cuts) blades.push_back(way_of_blade(s, span, tissue, stage, way));
  for (std::size_t k = 0; k < s.cuts.size(); ++k) add_to_push(s, blades[k], s.cuts[k]);
  for (std::size_t k = 0; k < s.cuts.size(); ++k) cut_along_blade(s, blades[k], s.cuts[k], way);
  if (const std::string trouble = find_trouble(s); !trouble.empty())
    throw SimulationError("after the cut at " + short_text(span.t1) + " s: " + trouble);
}

void prepare_cutters(Simulation& s) {
  if (s.mesh.dimension() == 2) return;
  for (CutStage& stage : s.cuts) stage.tet.prepare(s.mesh);
}

// Of `root`, a number among these ranks.
static void share_stroke(const Communicator& ranks, int root, CutStage& stage) {
  Saver save;
  if (ranks.rank() == root) save(stage.tet.stroke());
  std::vector<std::byte> bytes = save.take();
  ranks.broadcast(bytes, root);
  if (ranks.rank() == root) return;
  CutStroke stroke;
  Loader load(bytes);
  load(stroke);
  stage.tet.set_stroke(std::move(stroke));
}

void bring_stroke(const Simulation& s, std::span<const int> ranks, CutStage& stage) {
  std::vector<int>& keepers = stage.keepers;
  if (keepers.empty() || std::ranges::includes(keepers, ranks)) return;
  const auto is_keeper = [&](int rank) { return std::ranges::binary_search(keepers, rank); };
  const auto first = std::ranges::find_if(ranks, is_keeper);
  if (first == ranks.end()) {
    share_stroke(*s.communicator, keepers.front(), stage);
    keepers.clear();
    return;
  }
  if (const Communicator* const group = s.communicator->group(ranks))
    share_stroke(*group, static_cast<int>(first - ranks.begin()), stage);
  keepers.insert(keepers.end(), ranks.begin(), ranks.end());
  sort_unique(keepers);
}

}  // namespace trocar
