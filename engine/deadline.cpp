#include "engine/deadline.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/number_text.h"

namespace trocar {

Deadline deadline_of(const SceneTime& time, std::int64_t frame, double now) {
  const double left = time.at(frame) - now;
  if (left < 0) return {.late = -left, .shift = time.overrun == Overrun::shift ? -left : 0};
  const double wait = std::min(left, time.at(1));
  return {.wait = wait, .shift = wait - left};
}

void start_clock(Simulation& s) {
  if (s.scene.time.pace == Pace::real_time) s.communicator->barrier();
  s.start_seconds = monotonic_seconds() - s.scene.time.at(s.frame);
}

Deadline wait_for_deadline(Simulation& s) {
  if (s.scene.time.pace != Pace::real_time) return {};
  const double now = s.communicator->all_max(monotonic_seconds() - s.start_seconds);
  const Deadline deadline = deadline_of(s.scene.time, s.frame, now);
  s.start_seconds += deadline.shift;
  if (deadline.late > 0) ++s.log.n_deadlines_missed;
  const PhaseScope scope(s.timers, phase_wait);
  if (deadline.wait > 0) std::this_thread::sleep_for(std::chrono::duration<double>(deadline.wait));
  return deadline;
}

bool ends_run(const SceneTime& time, const Deadline& deadline) {
  return time.overrun == Overrun::stop && deadline.late > 0;
}

std::string missed_text(const Simulation& s, const Deadline& deadline, const PhaseTotals& before) {
  const auto in_ms = [](double seconds) { return short_text(1e3 * seconds) + " ms"; };
  PhaseTotals taken = s.timers.totals();
  for (std::size_t k = 0; k < before.size(); ++k) taken[k].second -= before[k].second;
  const auto most = std::ranges::max_element(taken, {}, &PhaseTotals::value_type::second);
  std::string text = "frame " + std::to_string(s.frame) + " was done " + in_ms(deadline.late) +
                     " after its deadline, and overrun is \"stop\"";
  if (most != taken.end())
    text += ": of its " + in_ms(s.log.rows.back().latency) + " \"" + most->first +
            "\" took most, " + in_ms(most->second);
  if (s.scene.checkpoint.every > 0) text += "; --resume goes on behind it";
  return text;
}

}  // namespace trocar
