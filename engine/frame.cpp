// One frame of a running scene (the whole program exists to call run_frame). Read it from the end:
// run_frame, step_safely, run_substeps, substep. docs/architecture.md lists the stages.
#include "engine/frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/number_text.h"
#include "engine/checkpoint_output.h"
#include "engine/contact_step.h"
#include "engine/cut_front.h"
#include "engine/event_log.h"
#include "engine/frame_force.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "engine/linear_range.h"
#include "engine/pair_look.h"
#include "engine/roll_back.h"
#include "engine/tool_report.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Central differences conserve an energy near the true one for a constant step. One that follows
// the deformation up and down swings with the tissue's own modes and drives them, below the
// resonance too (docs/cutting.md). So it rises by this part of the time that passes: 1e-4 of itself
// a step.
constexpr double step_rise = 1e-4;

// What step_factor and step_scale are parts of.
double stable_step_of_frame(const Simulation& s) {
  const double of_tissue = step_share(s) * std::min(s.watch.stable_step, s.held_step);
  return std::min(of_tissue, s.held_by_contact);
}

void plan_substeps(const Simulation& s, FrameSpan& span) {
  const double length = 1 / s.scene.time.frame_rate;
  const double dt = s.step_factor * s.step_scale * stable_step_of_frame(s);
  CHECK_OP(dt, >, 0);
  span.n_substeps = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(length / dt)));
  span.dt = length / static_cast<double>(span.n_substeps);
}

FrameSpan next_frame(const Simulation& s) {
  return {.t0 = s.scene.time.at(s.frame), .t1 = s.scene.time.at(s.frame + 1)};
}

// What is held otherwise moves otherwise.
void take_up_holds(Simulation& s) {
  localise_holds(s.holds, s.part);
  if (s.sleep) s.sleep->quiet_time = 0;
}

// What graspers and scissors do as the frame begins.
void open_and_close(Simulation& s) {
  const double before = s.scene.time.at(s.frame - 1), now = s.scene.time.at(s.frame);
  const std::vector<DueAct> due = due_acts(s.tools, before, now);
  if (due.empty()) return;
  std::vector<Vec3> x;
  if (does_grasper_close(due, s.tools)) x = gather_state(s).x;
  const std::vector<GraspAct> acts = act_graspers(s.holds, s.tools, due, {now, x, s.fixed});
  if (!acts.empty()) take_up_holds(s);
  for (const GraspAct& act : acts) note_grasp(s, now, act);
}

// travel: the longest way that a node makes within the frame at its present speed. [m]
void detect(Simulation& s, const FrameSpan& span, double travel) {
  const PhaseScope scope(s.timers, phase_detect);
  const double time = span.t1 - span.t0;
  // Supports and graspers that set out within the frame take tissue along.
  const double moved = largest_travel(s.holds, s.tools, span.t0, span.t1);
  detect_contacts(*s.contact, s.tools, s.holds, s.view, span, s.contact_reach + travel + moved);
  if (s.contact->has_tissue) {
    gather_velocities(s.view, s.state.v, *s.communicator);
    detect_tissue(*s.contact, s.view, time, s.contact_reach);
  }
  prepare_frame_contacts(*s.contact, contact_body(s), s.holds);
}

// Pushes tissue out of the instruments that it would be in at the end of the step.
void resolve_contacts(Simulation& s, const FrameSpan& span, std::int64_t k) {
  ContactStage& contact = *s.contact;
  if (contact.set.node.empty()) return;
  move_tools(s.tools, span.time(k + 1), span.dt, contact.motion);
  predict(s.model, s.scratch, s.holds.prescribed, contact.set.local, span.dt, s.state,
          contact.u_next);
  share_positions(contact, s.mesh.X, s.state.u, *s.communicator);
  const ContactStep step = {.tools = contact.motion,
                            .number = k,
                            .dt = span.dt,
                            .response = step_response(s.model, s.state, span.dt)};
  look_again(contact.detector, step, contact.set);
  solve_contacts(contact.detector, step, contact.options, contact.set);
  add_contact_force(contact, s.scratch.force);
}

// Of elements and loads. The first of a frame may be known from the look at the end of the one
// before.
void update_force(Simulation& s, double time) {
  const ForceScope scope(s);
  if (!s.scratch.has_force) find_force(s.model, s.neighbours, s.state, s.scratch);
  s.scratch.has_force = false;  // from here on it is added to
  find_viscous_force(s.model, s.state, s.scratch);
  find_loads_at(s, time);
  add_loads(s.loads, 1, s.scratch.force);
}

void list_waiting(Simulation& s) {
  s.waiting.node.clear();
  if (s.contact) s.waiting.node = s.contact->set.local;
  for (const PrescribedNode& node : s.holds.prescribed) s.waiting.node.push_back(node.node);
  for (const BladeDrag::Node& node : s.drag.node) s.waiting.node.push_back(node.local);
  mark_waiting(s.model, s.waiting);
}

// Whether nothing but elements and supports at rest acts on the nodes that don't wait, so that they
// can move while their forces are found.
bool moves_at_once(const Simulation& s) {
  return !s.scratch.has_force && !s.energy && !s.multirate && s.loads.is_empty() &&
         s.model.clusters.node.empty();
}

void substep(Simulation& s, const FrameSpan& span, std::int64_t k) {
  const bool at_once = moves_at_once(s);
  if (at_once) {
    const ForceScope scope(s);
    step_others(s.model, s.neighbours, s.waiting, span.dt, s.state, s.scratch);
  } else {
    update_force(s, span.time(k));
  }
  aim_holds(s.holds, s.tools, s.mesh.X, span.time(k + 1));
  if (s.contact) {
    const PhaseScope scope(s.timers, phase_contact);
    add_drag(s.model, s.state, span.dt, s.drag, s.scratch.force);
  }
  if (s.has_local_steps) {
    const ForceScope scope(s);
    refine_forces(s, span.dt);
  }
  if (s.contact) {
    const PhaseScope scope(s.timers, phase_contact);
    resolve_contacts(s, span, k);
  }
  {
    const PhaseScope scope(s.timers, phase_integrate);
    if (s.energy) note_velocities(s, span.dt);
    if (at_once)
      step_waiting(s.model, s.waiting, s.holds.prescribed, span.dt, s.state, s.scratch);
    else
      integrate(s.model, s.scratch, s.holds.prescribed, span.dt, s.state);
    add_hold_reactions(s.holds);
  }
  const PhaseScope scope(s.timers, phase_exchange);
  start_exchange(s.neighbours, s.state);
  if (!s.energy) return;
  finish_exchange(s.neighbours, s.state);
  add_work(s);
}

void look_again_for_pairs(Simulation& s, const FrameSpan& span, std::int64_t k) {
  const PhaseScope scope(s.timers, phase_detect);
  if (!is_pair_look_due(s, span, k)) return;
  look_for_pairs(s, span, k);
  list_waiting(s);
}

FrameSpan begin_substeps(Simulation& s) {
  FrameSpan span = next_frame(s);
  double travel = 0;
  if (s.contact) {
    travel = largest_speed(s) * (span.t1 - span.t0);
    detect(s, span, travel);
  }
  if (!s.cuts.empty()) prepare_drag(s, span, travel);
  choose_local_steps(s, span.t0);
  plan_substeps(s, span);
  if (s.contact && s.contact->has_tissue) note_pair_look(s, span, 0);
  if (s.sleep) wake_touched(s);
  list_waiting(s);
  if (s.energy) begin_frame_work(s);
  return span;
}

void step_on(Simulation& s, const FrameSpan& span, std::int64_t k) {
  if (s.contact && s.contact->has_tissue) look_again_for_pairs(s, span, k);
  substep(s, span, k);
}

FrameSpan run_substeps(Simulation& s) {
  const FrameSpan span = begin_substeps(s);
  for (std::int64_t k = 0; k < span.n_substeps; ++k) step_on(s, span, k);
  return span;
}

void go_to_start(Simulation& s) {
  finish_exchange(s.neighbours, s.state);
  s.state = s.frame_start;
  s.scratch.has_force = false;
  forget_hold_reactions(s.holds);
}

// Why a frame's numbers came to be infinite: its steps once more, looked at one by one, until an
// element is inverted. Leaves the look at that in s.watch. "" if none was: what isn't finite came
// from elsewhere.
std::string find_first_inverted(Simulation& s) {
  const Watch end = s.watch;
  go_to_start(s);
  const FrameSpan span = begin_substeps(s);
  for (std::int64_t k = 0; k < span.n_substeps; ++k) {
    step_on(s, span, k);
    look_for_inversion(s);
    if (!s.watch.is_finite) break;
    if (s.watch.least_J > 0) continue;
    return "displacements grow beyond all numbers from step " + std::to_string(k + 1) + " of " +
           std::to_string(span.n_substeps) + " on, as " + find_trouble(s);
  }
  s.watch = end;
  return "";
}

// The limit may have been lower within the frame than it is at its end: where the step was 0.985 of
// it at the end, elements had swung up by a third of the body's energy. So the step must leave half
// of what step_factor keeps off the limit. Bounds of single elements are below the limit anyway.
bool was_stable(const Simulation& s, const FrameSpan& span) {
  const bool is_limit = s.scene.solver.stable_step == StableStep::frequency;
  const double most = is_limit ? 0.5 * (1 + s.step_factor) : 1;
  return span.dt <= most * step_share(s) * s.watch.stable_step;
}

// All substeps of the frame, twice if they disturb what slept. On trouble they are done again from
// the frame's beginning with half the step, and likewise with a smaller step if the tissue
// stiffened beyond it, at most `most_roll_backs` times.
FrameSpan step_safely(Simulation& s) {
  s.frame_start = s.state;
  // Those of a failed frame hold no step to go on with.
  const Watch good_watch = s.watch;
  const double of_small = s.look.of_small;
  for (int tries = 0;; ++tries) {
    FrameSpan span = run_substeps(s);
    if (s.sleep && wake_disturbed(s)) {
      go_to_start(s);
      span = run_substeps(s);
    }
    watch_state(s);
    std::string trouble = find_trouble(s);
    if (trouble.empty() && was_stable(s, span)) return span;
    if (!s.watch.is_finite)
      if (const std::string why = find_first_inverted(s); !why.empty()) trouble = why;
    go_to_start(s);
    if (trouble.empty()) {
      repeat_frame(s, span, tries);
    } else {
      const Watch failed = std::exchange(s.watch, good_watch);
      s.look.of_small = of_small;
      roll_back(s, span, failed, trouble, tries);
    }
  }
}

// Tissue that pulls at jaws with more than they hold slips out of them.
void let_slip(Simulation& s, const FrameSpan& span, const FrameRow& row) {
  for (std::size_t k = 0; k < s.tools.size(); ++k) {
    const double most = s.tools[k].grip_force, pull = row.tools[k].pull.norm();
    if (most == 0 || pull <= most) continue;
    const int n = release(s.holds, static_cast<std::int32_t>(k));
    if (n == 0) continue;
    take_up_holds(s);
    note_event(s, span.t1,
               "tissue slips out of " + s.tools[k].name + ", " + std::to_string(n) +
                   " nodes: it pulls with " + short_text(pull) + " N, grip_force is " +
                   short_text(most) + " N");
  }
}

// What the next frames' steps follow from. before: the tissue's stable step at the frame's start.
void hold_step(Simulation& s, const FrameSpan& span, double before) {
  const double rise = step_rise / s.scene.time.frame_rate;
  s.held_step = std::min(s.watch.stable_step, before + rise);
  s.held_by_contact = std::min(step_limit_of_contact(s, span), s.held_by_contact + rise);
}

// What roll-backs have taken from the step comes back as slowly as the stable step rises.
void recover_step_scale(Simulation& s, const FrameSpan& span) {
  if (s.step_scale == 1) return;
  s.step_scale += step_rise * (span.t1 - span.t0) / stable_step_of_frame(s);
  if (s.step_scale < 1) return;
  s.step_scale = 1;
  note_event(s, span.t1, "the step is whole again");
}

}  // namespace

void step_alone(Simulation& s, double dt) {
  if (moves_at_once(s)) {
    step_others(s.model, s.neighbours, {}, dt, s.state, s.scratch);
    step_waiting(s.model, {}, {}, dt, s.state, s.scratch);
  } else {
    find_force(s.model, s.neighbours, s.state, s.scratch);
    refine_forces(s, dt);
    integrate(s.model, s.scratch, {}, dt, s.state);
  }
  start_exchange(s.neighbours, s.state);
}

void run_frame(Simulation& s, Outputs& outputs) {
  const double start = monotonic_seconds();
  open_and_close(s);
  const double stable_before = std::min(s.watch.stable_step, s.held_step);
  const FrameSpan span = step_safely(s);
  hold_step(s, span, stable_before);
  recover_step_scale(s, span);
  // What the substeps have done, before a cut changes what touches and holds the body.
  if (s.energy) close_frame_work(s);
  watch_linear_range(s, span.t1);
  FrameRow row = report_forces(s, span);
  let_slip(s, span, row);
  if (!s.cuts.empty()) cut_along_blades(s, span);
  if (s.sleep) fall_asleep(s, row.tools);
  ++s.frame;
  // What the frame tells, and what is due.
  if (needs_surface(s, outputs)) refresh_surface(s);
  if (s.contact && s.contact->has_tissue) watch_sunk_tissue(s, span.t1);
  report_state(s, row);
  row.seconds = row.latency = monotonic_seconds() - start;
  s.log.rows.push_back(std::move(row));
  write_outputs(s, outputs, s.log.rows.back());
  if (is_checkpoint_due(s)) write_checkpoint(s, outputs);
  s.log.rows.back().latency = monotonic_seconds() - start;
}

}  // namespace trocar
