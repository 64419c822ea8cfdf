#include "engine/deadline.h"

#include <chrono>
#include <thread>

namespace trocar {

double left_of_frame(const Simulation& s, double now) {
  return s.start_seconds + s.scene.time.at(s.frame) - now;
}

void wait_for_deadline(Simulation& s) {
  if (s.scene.time.pace != Pace::real_time) return;
  const double left = left_of_frame(s, monotonic_seconds());
  if (left < 0) ++s.log.n_deadlines_missed;
  const PhaseScope scope(s.timers, phase_wait);
  if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

}  // namespace trocar
