// Wall seconds by phase, and the clocks that deadlines and costs are measured with.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace trocar {

// Seconds of a monotonic clock.
double monotonic_seconds();
double thread_seconds();  // processor time of this thread [s]

// Adds up wall seconds by named phase. Phases are registered once and then addressed by index.
class PhaseTimers {
 public:
  // Index of the phase with this name; a new one is added at the end.
  std::size_t phase(const std::string& name);
  void add(std::size_t phase, double seconds) { seconds_[phase] += seconds; }
  // (name, seconds) in order of registration.
  std::vector<std::pair<std::string, double>> totals() const;

 private:
  std::vector<std::string> names_;
  std::vector<double> seconds_;
};

// Counts the time of its own life to one phase.
class PhaseScope {
 public:
  PhaseScope(PhaseTimers& timers, std::size_t phase)
      : timers_(timers), phase_(phase), start_(monotonic_seconds()) {}
  ~PhaseScope() { timers_.add(phase_, monotonic_seconds() - start_); }
  PhaseScope(const PhaseScope&) = delete;
  PhaseScope& operator=(const PhaseScope&) = delete;

 private:
  PhaseTimers& timers_;
  std::size_t phase_;
  double start_;
};

}  // namespace trocar
