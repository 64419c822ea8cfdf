#include "engine/frame_report.h"

#include <algorithm>
#include <utility>

#include "base/exact_sum.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Steps leave out elements that sleep: what supports of theirs bear is that of the frame's end.
void wake_support_forces(Simulation& s, std::int64_t n_substeps) {
  if (!s.sleep || s.sleep->share == 0) return;
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
}

// Mean over the frame of what the tissue does to each tool, by contact, held nodes and the blade's
// resistance, and to each support.
void sum_forces(Simulation& s, const FrameSpan& span, FrameRow& row) {
  std::vector<ToolLoad> loads(s.tools.size());
  std::vector<ExactSum3> sums(s.scene.supports.size());
  if (s.contact) sum_contact_reactions(*s.contact, span.n_substeps, loads);
  sum_hold_reactions(s.holds, span.n_substeps, loads, sums);
  sum_drag_reactions(s.drag, span.n_substeps, loads);
  if (s.energy) {
    wake_support_forces(s, span.n_substeps);
    sum_support_forces(s.energy->support_forces, span.n_substeps, sums);
  } else {
    sums.clear();
  }
  for (const ToolLoad& load : loads) sums.insert(sums.end(), {load.force, load.torque, load.pull});
  const std::vector<Vec3> of_all = sum_over_ranks(sums, *s.communicator);
  const auto of_tools = of_all.end() - 3 * std::ssize(s.tools);
  row.support_forces.assign(of_all.begin(), of_tools);
  for (std::size_t k = 0; k < s.tools.size(); ++k) {
    const auto of_tool = of_tools + 3 * static_cast<std::ptrdiff_t>(k);
    row.tools.push_back({.position = s.tools[k].path.at(span.t1).translation,
                         .force = of_tool[0],
                         .pull = of_tool[2]});
    if (s.energy) row.tools[k].torque = of_tool[1];
  }
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
  const PhaseScope scope(s.timers, phase_watch);
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
  const PhaseScope scope(s.timers, phase_watch);
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

}  // namespace trocar
