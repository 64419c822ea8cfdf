#include "engine/frame_watch.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "base/error.h"
#include "base/log.h"
#include "engine/frame_report.h"
#include "solver/step.h"

namespace trocar {

namespace {

// The least of all ranks' values with its number; ties go to the lower number.
void least_of_all(const Communicator& communicator, double& value, std::int32_t& number) {
  const double least = communicator.all_min(value);
  const double mine = value == least && number >= 0 ? number : 1e18;
  number = static_cast<std::int32_t>(std::min(communicator.all_min(mine), 2147483647.0));
  value = least;
}

}  // namespace

void average_volume(Simulation& s) {
  if (!s.exchange_theta) return;
  {
    const PhaseScope scope(s.timers, phase_force);
    average_volume_change(s.model, s.state, s.scratch);
  }
  const PhaseScope scope(s.timers, phase_exchange);
  s.exchange_theta->exchange(s.state.theta, *s.communicator);
}

void watch_state(Simulation& s) {
  average_volume(s);
  const PhaseScope scope(s.timers, phase_watch);
  Watch w = watch(s.model, s.part, s.state);
  const Communicator& communicator = *s.communicator;
  const double bad = communicator.all_min(w.is_finite ? 1e18 : static_cast<double>(w.bad_node));
  w.is_finite = bad > 9e17;
  w.bad_node = w.is_finite ? -1 : static_cast<std::int32_t>(bad);
  if (!w.is_finite) {  // steps and J of a broken state mean nothing
    s.watch.is_finite = false;
    s.watch.bad_node = w.bad_node;
    return;
  }
  least_of_all(communicator, w.stable_step, w.stable_element);
  least_of_all(communicator, w.least_J, w.least_J_element);
  s.watch = w;
}

std::string find_trouble(const Simulation& s) {
  if (!s.watch.is_finite)
    return "a non-finite displacement or velocity at node " + std::to_string(s.watch.bad_node) +
           " (the step was unstable or a load is not finite)";
  if (!(s.watch.least_J > 0))
    return "element " + std::to_string(s.watch.least_J_element) +
           " is inverted (det F = " + std::to_string(s.watch.least_J) + ")";
  return {};
}

void roll_back(Simulation& s, const std::string& trouble, int tries) {
  const double time = static_cast<double>(s.frame) / s.scene.time.frame_rate;
  ++s.log.n_roll_backs;
  const std::string sentence = "in the frame after " + number_text(time) + " s: " + trouble;
  if (tries >= most_roll_backs)
    throw SimulationError(sentence + "; " + std::to_string(tries) +
                          " roll-backs with smaller steps did not help: slower instruments, a "
                          "finer mesh or a lower poisson_ratio may");
  s.step_scale *= 0.5;
  s.watch.is_finite = true;
  for (Vec3& sum : s.holds.reaction_sum) sum = Vec3::Zero();
  note_event(s, time, "rolled back: " + trouble + "; step scale now " + number_text(s.step_scale));
}

void wait_for_deadline(Simulation& s, const FrameRow& row) {
  if (s.scene.time.pace != Pace::real_time) return;
  const double length = 1 / s.scene.time.frame_rate;
  if (row.seconds > length) ++s.log.n_deadlines_missed;
  const PhaseScope scope(s.timers, phase_wait);
  const double deadline = s.start_seconds + static_cast<double>(s.frame) * length;
  const double left = deadline - monotonic_seconds();
  if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

}  // namespace trocar
