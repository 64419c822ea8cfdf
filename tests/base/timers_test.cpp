#include "base/timers.h"

#include <gtest/gtest.h>

#include <thread>

namespace trocar {
namespace {

// Read between two readings of the other clock, however long the machine lets this test wait.
TEST(MonotonicSeconds, advance_with_the_wall_clock) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  };
  constexpr double rounding = 1e-6;  // of seconds since the machine was started
  const Clock::time_point earliest = Clock::now();
  const double before = monotonic_seconds();
  const Clock::time_point begin = Clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const Clock::time_point end = Clock::now();
  const double elapsed = monotonic_seconds() - before;
  const Clock::time_point latest = Clock::now();
  EXPECT_GE(elapsed, seconds(end - begin) - rounding);
  EXPECT_LE(elapsed, seconds(latest - earliest) + rounding);
}

TEST(ThreadSeconds, stand_while_the_thread_sleeps_and_advance_while_it_works) {
  const double wall = monotonic_seconds(), start = thread_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const double woken = thread_seconds();
  EXPECT_LT(woken - start, 0.5 * (monotonic_seconds() - wall));
  while (monotonic_seconds() - wall < 10 && thread_seconds() - woken < 1e-3) {
  }
  EXPECT_GE(thread_seconds() - woken, 1e-3);
}

TEST(PhaseTimers, add_up_by_phase_in_order_of_registration) {
  PhaseTimers timers;
  const std::size_t step = timers.phase("step");
  const std::size_t contact = timers.phase("contact");
  EXPECT_EQ(timers.phase("step"), step);
  timers.add(step, 1.5);
  timers.add(contact, 0.25);
  timers.add(step, 0.5);
  const std::vector<std::pair<std::string, double>> expected{{"step", 2.0}, {"contact", 0.25}};
  EXPECT_EQ(timers.totals(), expected);
}

TEST(PhaseScope, counts_its_own_life) {
  PhaseTimers timers;
  {
    const PhaseScope scope(timers, timers.phase("sleep"));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(timers.totals()[0].second, 0);
  }
  EXPECT_GE(timers.totals()[0].second, 0.020);
}

}  // namespace
}  // namespace trocar
