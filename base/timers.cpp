// Wall seconds by phase.
#include "base/timers.h"

#include <time.h>

#include <algorithm>

namespace trocar {

double monotonic_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::size_t PhaseTimers::phase(const std::string& name) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  const auto index = static_cast<std::size_t>(found - names_.begin());
  if (found == names_.end()) {
    names_.push_back(name);
    seconds_.push_back(0);
  }
  return index;
}

std::vector<std::pair<std::string, double>> PhaseTimers::totals() const {
  std::vector<std::pair<std::string, double>> result;
  result.reserve(names_.size());
  for (std::size_t i = 0; i < names_.size(); ++i) result.emplace_back(names_[i], seconds_[i]);
  return result;
}

}  // namespace trocar
