#include "engine/body_search.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/number_text.h"
#include "engine/event_log.h"
#include "engine/part_search.h"
#include "solver/step.h"

namespace trocar {

namespace {

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
  MultiRate& m = *s.multirate;
  s.model.fixed.swap(s.multirate->coarse_fixed);
  const double coarse = search_step(s);
  s.model.fixed.swap(s.multirate->coarse_fixed);
  if (coarse == 0) return 0;
  const double step = std::min(coarse, step_without * m.steps.limit / 2);
  const double cost = 1 + static_cast<double>(m.steps.gain.size()) * m.share;
  m.is_judged |= step > least_local_gain * cost * step_without;
  if (m.is_judged) return step;
  s.multirate.reset();
  note_event(s, s.state.time,
             "no local steps (solver.multirate): they would take " +
                 short_text(100 * step_without * cost / step) + " % of the work without");
  return step_without;
}

double step_of_frequency(Simulation& s) {
  if (s.sleep) show_awake(s);  // the step must do when they wake
  double step = search_step(s);
  s.look.of_small = 1;
  if (s.multirate && step > 0) {
    const double without = step;
    step = step_with_local_steps(s, without);
    if (step > 0) s.look.of_small = without / step;
  }
  if (s.sleep) show_asleep(s);
  return step;
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

}  // namespace

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

void note_look(Simulation& s, double step, std::vector<double> stiffening) {
  follow_from_here(s, step);
  s.look.at_step = s.state.step;
  s.look.stiffening = std::move(stiffening);
}

bool follows_search(const Simulation& s) {
  return s.scene.solver.stable_step == StableStep::frequency && s.look.is_done &&
         s.state.step - s.look.at_step < most_steps_of_search;
}

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

}  // namespace trocar
