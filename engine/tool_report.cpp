#include "engine/tool_report.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "cutting/cut_bridge.h"
#include "engine/event_log.h"
#include "engine/point_text.h"

namespace trocar {

void note_grasp(Simulation& s, double time, const GraspAct& act) {
  const Tool& tool = s.tools[act.tool];
  std::string text = " opens";
  if (act.n_taken > 0)
    text = " closes on " + (act.n_taken == 1 ? "one node" : std::to_string(act.n_taken) + " nodes");
  else if (act.has_closed && std::isinf(act.nearest))
    text = " closes on nothing: all nodes are held by others";
  else if (act.has_closed)
    text = " closes on nothing: the nearest free node is " + short_text(1e3 * act.nearest) +
           " mm from its tip, and it grips within " + short_text(1e3 * tool.grip_radius) + " mm";
  note_event(s, time, tool.name + text);
}

void note_refusals(Simulation& s, const CutRecord& record) {
  if (record.figures.refusals.empty()) return;
  const CutRefusal& first = record.figures.refusals.front();
  const bool is_one = record.figures.n_refused == 1;
  note_event(
      s, record.end,
      record.tool + " leaves tissue joined in " +
          (is_one ? "one place" : std::to_string(record.figures.n_refused) + " places, the first") +
          " at " + point_text(first.X) + " m of the undeformed body" +
          (first.area > 0 ? ", " + short_text(1e4 * first.area) + " cm^2" : "") + ": " +
          reason_of(first) + (is_one ? "" : " (all: `refusals` in the summary)"));
}

// Why a blade whose edge met resistance has parted nothing, "" where that is not why.
static std::string why_pushed(const Simulation& s, const BladePush& push) {
  constexpr double most = 0.5;
  if (push.way < s.edge_length || push.along < most * push.way) return "";
  return "the tissue went along with its edge on " + short_text(1e3 * push.along) + " of the " +
         short_text(1e3 * push.way) +
         " mm on which that met resistance: cutting.resistance is more than the tissue bears "
         "there; lower it, or support or hold the tissue";
}

static BladePush sum_of_pushes(std::span<const CutRecord> strokes) {
  BladePush sum;
  for (const CutRecord& stroke : strokes) {
    sum.way += stroke.push.way;
    sum.along += stroke.push.along;
  }
  return sum;
}

// Why strokes of a blade have parted nothing of the tissue that it was in.
static std::string why_nothing(const Simulation& s, std::span<const CutRecord> strokes) {
  constexpr double enough = 2;        // elements in the depth of a cut
  constexpr double far_enough = 1.5;  // elements that a cut may be behind its blade
  double deepest = 0, way = 0;
  bool goes_through = false, is_told = false;  // by note_refusals
  for (const CutRecord& stroke : strokes) {
    deepest = std::max(deepest, stroke.deepest);
    way = std::max(way, stroke.blade_travel);
    goes_through |= stroke.figures.goes_through;
    is_told |= !stroke.figures.refusals.empty();
  }
  if (const std::string why = why_pushed(s, sum_of_pushes(strokes)); !why.empty()) return why;
  const std::string elements =
      ", whose elements have edges of " + short_text(1e3 * s.edge_length) + " mm, and ";
  if (s.mesh.dimension() == 3 && !goes_through && deepest < enough * s.edge_length)
    return "no more than " + short_text(1e3 * deepest) + " mm of its edge was in the tissue" +
           elements +
           "a cut that ends inside needs two or three of them in its depth: a finer mesh, or let "
           "the blade go through" +
           (s.scene.cutting.resistance > 0 ? " (resistance is felt all the same)" : "");
  if (is_told) return "its strokes in the summary say where tissue stays joined";
  if (!goes_through && way < far_enough * s.edge_length)
    return "it went no farther than " + short_text(1e3 * way) + " mm in the tissue" + elements +
           "a cut stays half an edge to one and a half behind its blade";
  if (s.mesh.dimension() == 2)
    return "it went " + short_text(1e3 * way) +
           " mm through the tissue, but where it was parted already, or along its boundary";
  return "it went " + short_text(1e3 * way) + " mm through the tissue" + elements +
         "along its edge, as one that stabs, across too few of them, or so near to a surface, a "
         "support, an older cut or hexahedra that can't become tetrahedra that the slice is "
         "thinner than the mesh can show";
}

// Its strokes that parted nothing, of which the first is told of. Beside strokes that did, one that
// is still under way and one within an older slit are none.
static void note_idle_strokes(Simulation& s, const CutStage& stage) {
  const Tool& tool = s.tools[stage.tool];
  std::span<const CutRecord> strokes = stage.strokes;
  const auto has_cut = [](const CutRecord& stroke) { return stroke.figures.n_opened_facets > 0; };
  if (std::ranges::none_of(strokes, has_cut))
    return note_event(s, s.state.time, tool.name + " has cut nothing: " + why_nothing(s, strokes));
  if (stage.is_in_stroke) strokes = strokes.first(strokes.size() - 1);
  const auto is_idle = [&](const CutRecord& stroke) {
    return !has_cut(stroke) && !stroke.figures.is_in_slit;
  };
  const auto n_idle = std::ranges::count_if(strokes, is_idle);
  if (n_idle == 0) return;
  const CutRecord& first = *std::ranges::find_if(strokes, is_idle);
  note_event(s, s.state.time,
             tool.name + " has cut nothing in " + std::to_string(n_idle) + " of its " +
                 std::to_string(strokes.size()) + " strokes, first in that of " +
                 short_text(first.start) + " s: " + why_nothing(s, {&first, 1}));
}

static std::string why_no_stroke(const Simulation& s, const CutStage& stage) {
  if (std::string why = why_pushed(s, stage.push); !why.empty()) return why;
  return s.tools[stage.tool].kind == InstrumentKind::scissors
             ? "its jaws never closed on the tissue, and open blades neither part nor press it"
             : std::string("its blade never met the tissue") +
                   (s.mesh.dimension() == 2
                        ? ": in a plane scene it cuts where its edge crosses z = 0"
                        : "");
}

static void note_idle_blades(Simulation& s) {
  for (const CutStage& stage : s.cuts) {
    const Tool& tool = s.tools[stage.tool];
    if (stage.strokes.empty())
      note_event(s, s.state.time, tool.name + " has cut nothing: " + why_no_stroke(s, stage));
    else
      note_idle_strokes(s, stage);
  }
}

// Of a stroke that the run's end finds under way.
static void note_unfinished(Simulation& s, const CutStage& stage) {
  const CutRecord& record = stage.strokes.back();
  note_refusals(s, record);
  if (s.mesh.dimension() == 3 && stage.n_idle_frames == 0)
    note_event(s, s.state.time,
               record.tool +
                   " is still in the tissue: its cut ends half an edge to one and a half (" +
                   short_text(1.5e3 * s.edge_length) +
                   " mm) behind it, and what it has left joined is told once it is drawn out");
}

// Strokes around a piece that do not quite meet leave it hanging where nothing else is amiss.
static void note_bridges(Simulation& s) {
  if (s.cuts.empty() || s.mesh.dimension() == 2) return;
  for (const CutBridge& bridge : find_bridges(s.mesh, s.edge_length))
    note_event(s, s.state.time,
               "a part of " + short_text(1e6 * bridge.volume) +
                   " cm^3 hangs by few elements between cuts, at " + point_text(bridge.X) +
                   " m of the undeformed body: a stroke through there would free it; strokes that "
                   "cross by more than an edge leave no such place");
}

void note_tools_at_end(Simulation& s) {
  for (const CutStage& stage : s.cuts)
    if (stage.is_in_stroke) note_unfinished(s, stage);
  note_idle_blades(s);
  note_bridges(s);
  for (std::size_t k = 0; k < s.tools.size(); ++k)
    if (s.tools[k].kind == InstrumentKind::probe &&
        std::all_of(s.log.rows.begin(), s.log.rows.end(),
                    [&](const FrameRow& row) { return row.tools[k].force == Vec3::Zero(); }))
      note_event(s, s.state.time, s.tools[k].name + " has touched nothing");
}

}  // namespace trocar
