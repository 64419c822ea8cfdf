#include "engine/frame_watch.h"

#include <cmath>

#include "base/number_text.h"
#include "engine/body_search.h"
#include "engine/frame_force.h"
#include "solver/element_watch.h"
#include "solver/step.h"

namespace trocar {

namespace {

// The least of all ranks' values with its number; ties go to the lower number.
void least_of_all(const Communicator& communicator, double& value, std::int32_t& number) {
  const double least = communicator.all_min(value);
  number = communicator.lowest(value == least ? number : -1);
  value = least;
}

// Whether all is finite.
bool watch_nodes(Simulation& s) {
  s.watch.bad_node = s.communicator->lowest(first_bad_node(s.model, s.part, s.state));
  s.watch.is_finite = s.watch.bad_node < 0;
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

}  // namespace

bool keeps_forces(const Simulation& s) {
  return !s.sleep && s.model.averages.n_fields == 0 && !is_viscous(s.materials);
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

}  // namespace trocar
