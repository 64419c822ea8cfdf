#include "engine/frame_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/digest.h"
#include "base/exact_sum.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/options.h"
#include "engine/point_text.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Steps leave out elements that sleep: what supports of theirs bear is that of the frame's end.
void wake_support_forces(Simulation& s, std::int64_t n_substeps) {
  if (!s.sleep || s.sleep->share == 0) return;
  const std::vector<double> force = s.scratch.force;
  const bool has_force = s.scratch.has_force;
  std::vector<std::uint8_t> asleep = std::exchange(s.scratch.is_asleep, {});
  find_force(s.model, s.neighbours, s.state, s.scratch);
  add_loads(s.loads, 1, s.scratch.force);
  SupportForces& forces = s.energy->support_forces;
  for (std::size_t k = 0; k < forces.sum.size(); ++k) {
    const std::int64_t component = forces.of_rank[k].component;
    if (s.sleep->is_asleep[component / 3] != 0)
      forces.sum[k] = static_cast<double>(n_substeps) * s.scratch.force[component];
  }
  s.scratch.is_asleep = std::move(asleep);
  s.scratch.force = force;
  s.scratch.has_force = has_force;
}

// Mean over the frame of what the tissue does to each tool, by contact, held nodes and the blade's
// resistance, and to each support.
void sum_forces(Simulation& s, const FrameSpan& span, FrameRow& row) {
  std::vector<ExactSum3> sums(s.tools.size()), on_support(s.scene.supports.size());
  if (s.contact) sum_contact_reactions(*s.contact, span.n_substeps, sums);
  sum_hold_reactions(s.holds, span.n_substeps, sums, on_support);
  sum_drag_reactions(s.drag, span.n_substeps, sums);
  row.tools.resize(s.tools.size());
  for (std::size_t k = 0; k < s.tools.size(); ++k) {
    row.tools[k].position = s.tools[k].path.at(span.t1).translation;
    row.tools[k].force = sum_over_ranks(sums[k], *s.communicator);
  }
  if (!s.energy) return;
  wake_support_forces(s, span.n_substeps);
  sum_support_forces(s.energy->support_forces, span.n_substeps, on_support);
  for (ExactSum3& sum : on_support)
    row.support_forces.push_back(sum_over_ranks(sum, *s.communicator));
}

// Partner nodes lay on each other when they were cut apart: their distance is how far the wound
// gapes.
void report_wound(const Simulation& s, FrameRow& row) {
  double sum = 0;
  for (std::size_t k = 0; k < s.duplicate_node.size(); ++k) {
    const Vec3 gap = s.view.x[s.duplicate_node[k]] - s.view.x[s.duplicate_parent[k]];
    row.wound_width = std::max(row.wound_width, gap.norm());
    sum += gap.norm();
  }
  if (!s.duplicate_node.empty())
    row.wound_width_mean = sum / static_cast<double>(s.duplicate_node.size());
}

void keep_extremes(Simulation& s) {
  if (s.watch.least_J < s.log.least_J) {
    s.log.least_J = s.watch.least_J;
    s.log.least_J_element = s.watch.least_J_element;
  }
  s.log.least_stable_step = std::min(s.log.least_stable_step, s.watch.stable_step);
  s.log.largest_stable_step = std::max(s.log.largest_stable_step, s.watch.stable_step);
}

}  // namespace

void refresh_surface(Simulation& s) {
  const PhaseScope scope(s.timers, phase_gather);
  gather_surface(s.view, s.mesh.X, s.state.u, *s.communicator);
}

FrameRow report_forces(Simulation& s, const FrameSpan& span) {
  FrameRow row{.frame = s.frame + 1,
               .step = s.state.step,
               .n_substeps = span.n_substeps,
               .time = span.t1,
               .dt = span.dt};
  sum_forces(s, span, row);
  if (s.contact) {
    row.n_contacts = static_cast<std::int64_t>(s.contact->contacts.size());
    row.n_tissue_contacts = static_cast<std::int64_t>(s.contact->tissue.size());
  }
  row.n_held = static_cast<std::int64_t>(s.holds.holds.size());
  return row;
}

void report_state(Simulation& s, FrameRow& row) {
  row.stable_step = s.watch.stable_step;
  row.least_J = s.watch.least_J;
  if (s.sleep) row.asleep = s.sleep->share;
  if (s.energy) {
    report_energies(s, row);
    row.markers = marker_positions(s.markers, s.mesh, s.part, s.state.u, *s.communicator);
  }
  if (!s.duplicate_node.empty()) report_wound(s, row);
  for (const CutStage& stage : s.cuts)
    for (const CutRecord& stroke : stage.strokes) row.n_edits += stroke.n_edits;
  row.n_pieces = s.n_pieces;
  keep_extremes(s);
}

static const std::string& add_event(Simulation& s, double time, const std::string& event) {
  return s.log.events.emplace_back(with_decimals(time, 3) + " s: " + event);
}

void note_event(Simulation& s, double time, const std::string& event) {
  log_info(add_event(s, time, event));
}

bool is_told(const Simulation& s, std::string_view part) {
  return std::ranges::any_of(s.log.events, [&](const std::string& event) {
    return event.find(part) != std::string::npos;
  });
}

void warn_event(Simulation& s, double time, const std::string& event) {
  log_warning(add_event(s, time, event));
}

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

static void note_idle_blades(Simulation& s) {
  for (const CutStage& stage : s.cuts) {
    const Tool& tool = s.tools[stage.tool];
    if (stage.strokes.empty())
      note_event(s, s.state.time,
                 tool.name + " has cut nothing: " +
                     (tool.kind == InstrumentKind::scissors ? "its jaws never closed on the tissue"
                                                            : "its blade never met the tissue"));
    else
      note_idle_strokes(s, stage);
  }
}

void note_idle_tools(Simulation& s) {
  for (const CutStage& stage : s.cuts)
    if (stage.is_in_stroke) note_refusals(s, stage.strokes.back());
  note_idle_blades(s);
  for (std::size_t k = 0; k < s.tools.size(); ++k)
    if (s.tools[k].kind == InstrumentKind::probe &&
        std::all_of(s.log.rows.begin(), s.log.rows.end(),
                    [&](const FrameRow& row) { return row.tools[k].force == Vec3::Zero(); }))
      note_event(s, s.state.time, s.tools[k].name + " has touched nothing");
}

std::uint64_t state_digest(const Simulation& s) {
  std::uint64_t sum = 0;
  for (std::int32_t i = 0; i < s.part.n_owned; ++i) {
    const auto k = static_cast<std::size_t>(i) * 3;
    const auto global = static_cast<std::uint64_t>(s.part.node_global[i]);
    const Vec3& X = s.mesh.X[global];
    const std::array<double, 9> values = {X[0],
                                          X[1],
                                          X[2],
                                          s.state.u[k],
                                          s.state.u[k + 1],
                                          s.state.u[k + 2],
                                          s.state.v[k],
                                          s.state.v[k + 1],
                                          s.state.v[k + 2]};
    sum += digest_item(global, values);
  }
  sum = s.communicator->all_sum(sum);
  for (std::int32_t e = 0; e < s.mesh.n_elements(); ++e)
    sum += digest_item((std::uint64_t{1} << 40) + static_cast<std::uint64_t>(e), s.mesh.corners(e));
  const std::array<double, 2> clock = {s.state.time, s.state.last_dt};
  sum += digest_item((std::uint64_t{1} << 41) + static_cast<std::uint64_t>(s.state.step), clock);
  return sum;
}

}  // namespace trocar
