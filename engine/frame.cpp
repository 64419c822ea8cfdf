// One frame of a running scene, top to bottom (the whole program exists to call run_frame).
#include "engine/frame.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "engine/apply_cut.h"
#include "engine/checkpoint_output.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "solver/step.h"

namespace trocar {

namespace {

FrameSpan plan_frame(const Simulation& s) {
  const double length = 1 / s.scene.time.frame_rate;
  FrameSpan span;
  span.t0 = static_cast<double>(s.frame) / s.scene.time.frame_rate;
  span.t1 = static_cast<double>(s.frame + 1) / s.scene.time.frame_rate;
  const bool has_contacts = !s.log.rows.empty() && s.log.rows.back().n_contacts > 0;
  const double dt = s.scene.solver.step_factor * s.step_scale * s.watch.stable_step /
                    (has_contacts ? s.scene.contact.refinement : 1);
  span.n_substeps = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(length / dt)));
  span.dt = length / static_cast<double>(span.n_substeps);
  return span;
}

void grasp(Simulation& s, const FrameSpan& span) {
  const double before = static_cast<double>(s.frame - 1) / s.scene.time.frame_rate;
  if (!will_act(s.tools, before, span.t0)) return;
  const int n_taken = act_graspers(s.holds, s.tools, before, span.t0, gather_state(s).x, s.fixed);
  localise_holds(s.holds, s.part);
  note_event(s, span.t0,
             n_taken > 0 ? "grasper closes on " + std::to_string(n_taken) + " nodes"
                         : "grasper opens or closes on nothing");
}

void detect(Simulation& s, const FrameSpan& span) {
  const PhaseScope scope(s.timers, phase_detect);
  detect_contacts(*s.contact, s.tools, s.holds, s.view, span, s.contact_reach);
  // A stiffness that grew with each roll-back would throw out what made the trouble even faster.
  prepare_frame_contacts(*s.contact, s.part, s.mass, span.dt / s.step_scale);
}

// What it waits for neighbours counts as exchange.
void update_force(Simulation& s) {
  const double waited = s.neighbours.waited;
  {
    const PhaseScope scope(s.timers, phase_force);
    find_force(s.model, s.neighbours, s.state, s.scratch);
  }
  s.timers.add(phase_exchange, s.neighbours.waited - waited);
  s.timers.add(phase_force, waited - s.neighbours.waited);
}

void substep(Simulation& s, const FrameSpan& span, double t) {
  update_force(s);
  if (s.contact) {
    const PhaseScope scope(s.timers, phase_contact);
    ContactStage& contact = *s.contact;
    move_tools(s.tools, t, span.dt, contact.motion);
    add_contact_force(contact.set, s.part, s.mesh.X, s.state.u, s.state.v, contact.motion,
                      contact.options, s.scratch.force, contact.reaction);
    add_contact_reactions(contact);
    add_cut_resistance(s, s.scratch.force);
  }
  {
    const PhaseScope scope(s.timers, phase_integrate);
    if (s.energy) note_velocities(s, span.dt);
    aim_holds(s.holds, s.tools, s.mesh.X, t + span.dt);
    integrate(s.model, s.scratch, s.holds.prescribed, span.dt, s.state);
    add_hold_reactions(s.holds);
  }
  const PhaseScope scope(s.timers, phase_exchange);
  start_exchange(s.neighbours, s.state);
  if (!s.energy) return;
  finish_exchange(s.neighbours, s.state);
  add_work(s);
}

FrameSpan run_substeps(Simulation& s) {
  const FrameSpan span = plan_frame(s);
  if (s.contact) detect(s, span);
  if (s.sleep) wake_touched(s);
  if (s.energy) begin_frame_work(s);
  for (std::int64_t k = 0; k < span.n_substeps; ++k)
    substep(s, span, span.t0 + static_cast<double>(k) * span.dt);
  return span;
}

void take_back(Simulation& s, const State& good) {
  finish_exchange(s.neighbours, s.state);
  s.state = good;
  for (Vec3& sum : s.holds.reaction_sum) sum = Vec3::Zero();
}

// All substeps of the frame, twice if they disturb what slept; on trouble back to its beginning
// with half the step, at most `most_roll_backs` times, and likewise with a smaller one if the
// tissue stiffened beyond it.
FrameSpan step_safely(Simulation& s) {
  const State good = s.state;
  const Watch good_watch = s.watch;  // that of a failed frame holds no step to go on with
  for (int tries = 0;; ++tries) {
    FrameSpan span = run_substeps(s);
    if (s.sleep && wake_disturbed(s)) {
      take_back(s, good);
      span = run_substeps(s);
    }
    watch_state(s);
    const std::string trouble = find_trouble(s);
    if (trouble.empty() && span.dt <= s.watch.stable_step) return span;
    s.state = good;
    if (trouble.empty()) {
      repeat_frame(s, span, tries);
    } else {
      s.watch = good_watch;
      roll_back(s, trouble, tries);
    }
  }
}

}  // namespace

void run_frame(Simulation& s, Outputs& outputs) {
  const double start = monotonic_seconds();
  grasp(s, plan_frame(s));
  const FrameSpan span = step_safely(s);
  if (s.energy) close_frame_work(s);
  FrameRow row = report_forces(s, span);
  if (!s.cuts.empty()) cut_along_blades(s, span);
  if (s.sleep) fall_asleep(s);
  ++s.frame;
  if (needs_surface(s, outputs)) refresh_surface(s);
  report_state(s, row);
  row.seconds = monotonic_seconds() - start;
  write_outputs(s, outputs, row);
  s.log.rows.push_back(std::move(row));
  if (is_checkpoint_due(s)) write_checkpoint(s, outputs);
  wait_for_deadline(s, s.log.rows.back());
}

}  // namespace trocar
