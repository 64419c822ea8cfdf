#include "engine/frame_watch.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "base/error.h"
#include "base/options.h"
#include "engine/frame_report.h"
#include "engine/part_search.h"
#include "engine/suspect.h"
#include "solver/element_watch.h"
#include "solver/frequency.h"
#include "solver/step.h"
#include "solver/thickness.h"

namespace trocar {

namespace {

// The least of all ranks' values with its number; ties go to the lower number.
void least_of_all(const Communicator& communicator, double& value, std::int32_t& number) {
  const double least = communicator.all_min(value);
  constexpr double none = 1e18;
  const double first = communicator.all_min(value == least && number >= 0 ? number : none);
  number = first < none ? static_cast<std::int32_t>(first) : -1;
  value = least;
}

// Forces of displacements for the search, halos and all. Fields go from hand to hand: a search has
// many.
void force_of(RankBody& body, State& probe, std::vector<double>& u, std::vector<double>& force) {
  probe.u.swap(u);
  body.scratch.force.swap(force);
  body.scratch.force.resize(3 * static_cast<std::size_t>(body.model.n_owned));
  start_exchange(body.neighbours, probe);
  find_force(body.model, body.neighbours, probe, body.scratch);
  body.scratch.force.swap(force);
  probe.u.swap(u);
}

// Forces follow from displacements, the search's, and history.
State without_motion(const State& state) {
  return {.theta = state.theta,
          .time = state.time,
          .last_dt = state.last_dt,
          .step = state.step,
          .history = state.history,
          .history_time = state.history_time};
}

double search_step(Simulation& s) {
  return search_step(s, search_amplitude(s.model, s.edge_length), *s.communicator);
}

// The body with its fine nodes at rest sets the step unless the fine ones do, in spite of their
// substeps. Local steps were planned from bounds, which are 0.5 to 1 of the true limits: those that
// don't pay are given up at the first look.
double step_with_local_steps(Simulation& s, double step_without) {
  const MultiRate& m = *s.multirate;
  s.model.fixed.swap(s.multirate->coarse_fixed);
  const double coarse = search_step(s);
  s.model.fixed.swap(s.multirate->coarse_fixed);
  const double step = std::min(coarse, step_without * m.steps.limit / 2);
  const double cost = 1 + static_cast<double>(m.steps.gain.size()) * m.share;
  if (s.look.is_done || step > least_local_gain * cost * step_without) return step;
  s.multirate.reset();
  note_event(s, s.state.time,
             "no local steps (solver.multirate): they would take " +
                 short_text(100 * step_without * cost / step) + " % of the work without");
  return step_without;
}

double step_of_frequency(Simulation& s) {
  if (s.sleep) show_awake(s);  // the step must do when they wake
  double step = search_step(s);
  if (s.multirate) step = step_with_local_steps(s, step);
  if (s.sleep) show_asleep(s);
  return step;
}

// Whether all is finite.
bool watch_nodes(Simulation& s) {
  constexpr double none = 1e18;
  const std::int32_t mine = first_bad_node(s.model, s.part, s.state);
  const double bad = s.communicator->all_min(mine < 0 ? none : mine);
  s.watch.is_finite = bad >= none;
  s.watch.bad_node = s.watch.is_finite ? -1 : static_cast<std::int32_t>(bad);
  return s.watch.is_finite;
}

// Whether elements may have other strains than at the last look.
bool may_look_different(const Simulation& s) {
  const ElementLook& look = s.look;
  const double reach = look.reach * std::min(1.0, s.watch.least_J);
  int has_moved = look.is_done && look.stiffening ? 0 : 1;
  const std::span<const double> u = look.u();
  for (std::size_t k = 0; k < u.size() && has_moved == 0; ++k)
    has_moved = std::abs(s.state.u[k] - u[k]) > reach ? 1 : 0;
  return s.communicator->all_max(has_moved) > 0;
}

void take_least(Simulation& s, Watch w) {
  least_of_all(*s.communicator, w.stable_step, w.stable_element);
  least_of_all(*s.communicator, w.least_J, w.least_J_element);
  s.watch = w;
}

void note_look(Simulation& s, double step, std::vector<double> stiffening) {
  follow_from_here(s, step);
  s.look.at_step = s.state.step;
  s.look.stiffening = std::move(stiffening);
}

// Whether the step follows from the last search.
bool follows_search(const Simulation& s) {
  return s.scene.solver.stable_step == StableStep::frequency && s.look.is_done &&
         s.state.step - s.look.at_step < most_steps_of_search;
}

constexpr double beyond_search = std::numeric_limits<double>::infinity();

// Growth since the search of the body by which the step follows from it; beyond_search where the
// body has to be searched again. Where a part is searched that has stiffened, the step is nearer to
// what the body allows, but that the rest has softened is not seen.
double search_if_due(Simulation& s, double growth) {
  const bool may_be_part = can_search_part(s);
  const bool is_due = growth > most_growth * s.look.growth ||
                      (may_be_part && growth > most_growth_of_part * s.look.asked);
  if (!is_due) return growth;
  if (!may_be_part || s.state.step - s.look.at_step > most_steps_of_parts) return beyond_search;
  growth = search_grown_part(s, growth);
  return growth <= most_growth * s.look.growth ? growth : beyond_search;
}

// The step of the last search, less by what any element has stiffened since (`growth`, at most of
// this rank); a new search where that is much, or where the last one was long ago and the tissue
// may have softened again.
double step_by_frequency(Simulation& s, double growth) {
  if (follows_search(s)) {
    growth = search_if_due(s, s.communicator->all_max(growth));
    if (growth < beyond_search) return s.look.step / std::sqrt(growth);
  }
  ++s.log.searches.n_of_body;
  s.look.stiffening.reset();
  const double step = step_of_frequency(s);
  std::vector<double> stiffening(s.part.element_global.size());
  watch(s.model, s.part, s.state, stiffening);
  note_look(s, step, std::move(stiffening));
  return step;
}

// Whether those of a frame's end are those of the next one's first step: sleeping elements have
// none, histories keep their time, and averages at nodes are exchanged in every step.
bool keeps_forces(const Simulation& s) {
  return !s.sleep && s.model.averages.n_fields == 0 && !is_viscous(s.materials);
}

void find_watched_force(Simulation& s, ElementWatch& elements) {
  const ForceScope scope(s);
  for (const std::int32_t e : s.look.decisive)
    if (e >= 0) elements.begin_with(s.model, s.state, e);
  find_force(s.model, s.neighbours, s.state, s.scratch, &elements);
  s.scratch.has_force = true;
}

// Returns the elements' largest growth since the last search, if the step follows from it.
double look_at_elements(Simulation& s) {
  if (follows_search(s) && !s.look.stiffening) {
    const PhaseScope scope(s.timers, phase_watch);
    find_stiffening_at_look(s);
  }
  ElementWatch elements(s.part,
                        {.earlier = follows_search(s) ? std::span<const double>(*s.look.stiffening)
                                                      : std::span<const double>()});
  if (keeps_forces(s)) {
    find_watched_force(s, elements);
  } else {
    const PhaseScope scope(s.timers, phase_watch);
    update_volume_change(s.model, s.neighbours, s.state, s.scratch);
    watch_elements(s.model, s.state, elements);
  }
  const PhaseScope scope(s.timers, phase_watch);
  take_least(s, elements.result());
  s.look.decisive = {elements.found().step.number, elements.found().stiffest};
  return elements.found().growth;
}

void watch_elements(Simulation& s) {
  const double growth = look_at_elements(s);
  const PhaseScope scope(s.timers, phase_watch);
  if (s.scene.solver.stable_step == StableStep::frequency && s.watch.least_J > 0)
    s.watch.stable_step = std::max(s.watch.stable_step, step_by_frequency(s, growth));
  else
    note_look(s, 0, {});
}

// Looks at the nodes; whether elements are to be looked at, too.
bool watch_motion(Simulation& s) {
  const PhaseScope scope(s.timers, phase_watch);
  finish_exchange(s.neighbours, s.state);
  if (!watch_nodes(s)) return false;  // steps and J of a broken state mean nothing
  const bool is_new = may_look_different(s);
  if (!is_new && s.energy) update_volume_change(s.model, s.neighbours, s.state, s.scratch);
  return is_new;
}

double waited_for_neighbours(const Simulation& s) {
  return s.neighbours.waited + (s.multirate ? s.multirate->neighbours.waited : 0);
}

}  // namespace

ForceScope::ForceScope(Simulation& s)
    : s_(s), start_(monotonic_seconds()), waited_(waited_for_neighbours(s)) {}

ForceScope::~ForceScope() {
  const double waited = waited_for_neighbours(s_) - waited_;
  s_.timers.add(phase_exchange, waited);
  s_.timers.add(phase_force, monotonic_seconds() - start_ - waited);
}

double search_step(RankBody& body, double amplitude, const Communicator& communicator,
                   double enough, const ForceOfDisplacement& more) {
  State probe = without_motion(body.state);
  std::vector<double> here = std::exchange(body.scratch.force, {});
  const auto forces = [&](std::vector<double>& u, std::vector<double>& force) {
    force_of(body, probe, u, force);
    if (more) more(u, force);
  };
  const FrequencyOptions options{
      .amplitude = amplitude,
      .of_interest = 2 / (frequency_margin * enough),
      .force = body.scratch.has_force ? std::span<const double>(here) : std::span<const double>()};
  const HighestFrequency found =
      find_highest_frequency(body.model, body.part, body.state, forces, options, communicator);
  body.scratch.force = std::move(here);
  return found.is_converged ? 2 / (frequency_margin * found.omega) : 0;
}

void follow_from_here(Simulation& s, double step) {
  ElementLook& look = s.look;
  look.is_done = true;
  look.step = step;
  const auto begin = s.state.u.begin();
  look.displacements =
      std::make_shared<std::vector<double>>(begin, begin + 3 * std::ptrdiff_t{s.model.n_owned});
  look.stiffening.reset();
  look.growth = look.asked = 1;
  look.searched.clear();
}

void find_stiffening_at_look(Simulation& s) {
  State there = s.state;
  std::ranges::copy(s.look.u(), there.u.begin());
  start_exchange(s.neighbours, there);
  update_volume_change(s.model, s.neighbours, there, s.scratch);
  s.look.stiffening.emplace(s.part.element_global.size());
  watch(s.model, s.part, there, *s.look.stiffening);
  take_searched(s.part, s.look.searched, *s.look.stiffening);
}

void refine_forces(Simulation& s, double dt) {
  if (!s.multirate) return;
  refine_force({.model = s.model, .state = s.state, .prescribed = s.holds.prescribed, .dt = dt},
               *s.multirate, s.scratch);
}

void find_loads_at(Simulation& s, double time) {
  if (s.loads.is_empty()) return;
  if (s.model.options.tri3 == Formulation::tri3_plane_stress)
    for (Loads::Face& face : s.loads.faces)
      if (face.element >= 0) face.stretch = thickness_stretch(s.model, s.state, face.element);
  find_loads(s.scene.loads, s.mesh, s.part, s.scene.tissue.thickness, time, s.state.u, s.loads);
}

double largest_speed(const Simulation& s) {
  double most = 0;
  for (std::int64_t i = 0; i < s.part.n_owned; ++i)
    most = std::max(most, Vec3::Map(&s.state.v[3 * i]).squaredNorm());
  return std::sqrt(s.communicator->all_max(most));
}

void watch_state(Simulation& s) {
  if (watch_motion(s)) watch_elements(s);
}

void look_for_inversion(Simulation& s) {
  finish_exchange(s.neighbours, s.state);
  if (!watch_nodes(s)) return;
  update_volume_change(s.model, s.neighbours, s.state, s.scratch);
  take_least(s, watch(s.model, s.part, s.state));
}

std::string find_trouble(const Simulation& s) {
  if (!s.watch.is_finite)
    return "a non-finite displacement or velocity at node " + std::to_string(s.watch.bad_node) +
           " (the step was unstable or a load is not finite)";
  if (!(s.watch.least_J > 0))
    return "element " + std::to_string(s.watch.least_J_element) +
           " is inverted (det F = " + std::to_string(s.watch.least_J) + ")";
  if (s.watch.stable_step < crushed_step * s.rest_step)
    return "element " + std::to_string(s.watch.stable_element) +
           " is crushed or overstretched: its stable step is " + short_text(s.watch.stable_step) +
           " s, the body's at rest " + short_text(s.rest_step) + " s";
  return {};
}

namespace {

// What both ways back to the frame's beginning have in common; the sentence's beginning.
std::string go_back(Simulation& s, const FrameSpan& span, const Watch& failed,
                    const std::string& trouble, int tries) {
  if (tries >= most_roll_backs) {
    const Suspect suspect = find_suspect(s, failed, span);
    throw SimulationError("in the frame after " + short_text(span.t0) + " s: " + trouble +
                          suspect.place + "; " + std::to_string(tries) +
                          " roll-backs with smaller steps did not help: " + suspect.cure + " may");
  }
  ++s.log.n_roll_backs;
  forget_hold_reactions(s.holds);
  s.look.is_done = false;  // it was of a state that is gone
  s.look.displacements.reset();
  return "rolled back: " + trouble;
}

}  // namespace

void repeat_frame(Simulation& s, const FrameSpan& span, int tries) {
  const std::string trouble = "the tissue's stable step fell to " +
                              short_text(s.watch.stable_step) + " s, " +
                              (s.watch.stable_step < span.dt ? "below" : "too near") +
                              " the step of " + short_text(span.dt) + " s";
  note_event(s, span.t0, go_back(s, span, s.watch, trouble, tries));
}

void roll_back(Simulation& s, const FrameSpan& span, const Watch& failed,
               const std::string& trouble, int tries) {
  const std::string sentence = go_back(s, span, failed, trouble, tries);
  s.step_scale *= 0.5;
  note_event(s, span.t0,
             sentence + find_suspect(s, failed, span).place + "; step scale now " +
                 short_text(s.step_scale));
}

double left_of_frame(const Simulation& s, double now) {
  return s.start_seconds + static_cast<double>(s.frame) / s.scene.time.frame_rate - now;
}

void wait_for_deadline(Simulation& s) {
  if (s.scene.time.pace != Pace::real_time) return;
  const double left = left_of_frame(s, monotonic_seconds());
  if (left < 0) ++s.log.n_deadlines_missed;
  const PhaseScope scope(s.timers, phase_wait);
  if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

}  // namespace trocar
