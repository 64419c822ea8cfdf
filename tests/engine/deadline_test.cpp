// Deadlines on a clock of the tests' own, which jumps: against a counter in whole numbers.
#include "engine/deadline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/timers.h"
#include "engine/state_digest.h"
#include "engine_started.h"

namespace trocar {
namespace {

constexpr Overrun all_overruns[] = {Overrun::catch_up, Overrun::shift, Overrun::stop};

SceneTime four_a_second(Overrun overrun) {
  return {.frame_rate = 4, .pace = Pace::real_time, .overrun = overrun};
}

TEST(Deadline, of_a_frame_does_not_depend_on_how_late_others_were_if_a_late_run_catches_up) {
  const SceneTime time = four_a_second(Overrun::catch_up);
  EXPECT_EQ(deadline_of(time, 3, 0.625).wait, 0.125);
  const Deadline exact = deadline_of(time, 3, 0.75), late = deadline_of(time, 3, 2);
  EXPECT_EQ(exact.wait, 0);
  EXPECT_EQ(exact.late, 0);
  EXPECT_EQ(late.late, 1.25);
  EXPECT_EQ(late.wait, 0);
  EXPECT_EQ(late.shift, 0);
}

TEST(Deadline, moves_by_the_lateness_if_the_scene_says_shift) {
  const Deadline late = deadline_of(four_a_second(Overrun::shift), 3, 2);
  EXPECT_EQ(late.late, 1.25);
  EXPECT_EQ(late.shift, 1.25);
  EXPECT_EQ(late.wait, 0);
}

TEST(Deadline, that_is_missed_ends_the_run_only_if_the_scene_says_stop) {
  for (const Overrun overrun : all_overruns) {
    const SceneTime time = four_a_second(overrun);
    EXPECT_FALSE(ends_run(time, deadline_of(time, 3, 0.75)));
    EXPECT_EQ(ends_run(time, deadline_of(time, 3, 0.875)), overrun == Overrun::stop);
  }
}

// What deadlines are, told anew in ticks of a clock.
struct Counter {
  Overrun overrun = Overrun::catch_up;
  std::int64_t length = 0, due = 0, n_missed = 0;  // due: the next deadline

  // When the next frame begins after one that is done now.
  std::int64_t begin_after(std::int64_t now) {
    std::int64_t begin = now;
    if (now > due) {
      ++n_missed;
      if (overrun == Overrun::shift) due = now;
    } else {
      begin = due = std::min(due, now + length);  // later only if the clock went back
    }
    due += length;
    return begin;
  }
};

// Ticks of 1/1024 s, and frames of 1/2 ... 1/64 s: doubles are exact.
class Script {
 public:
  Script(std::uint64_t seed, Overrun overrun) : random_(seed) {
    const auto rate = std::int64_t{2} << below(6);
    time_ = {.frame_rate = static_cast<double>(rate), .pace = Pace::real_time, .overrun = overrun};
    frame_ = static_cast<std::int64_t>(below(100));
    now_ = static_cast<std::int64_t>(below(1U << 30));
    start_ = seconds(now_) - time_.at(frame_);
    const std::int64_t length = ticks_a_second / rate;
    counter_ = {.overrun = overrun, .length = length, .due = now_ + length};
  }
  // Whether both agree on every frame.
  bool agrees() {
    for (int k = 0; k < 12; ++k) {
      take_time();
      const Deadline deadline = deadline_of(time_, ++frame_, seconds(now_) - start_);
      start_ += deadline.shift;
      if (deadline.late > 0) ++n_missed_;
      const std::int64_t due = counter_.due, begin = counter_.begin_after(now_);
      if (deadline.late != seconds(std::max<std::int64_t>(0, now_ - due)) ||
          deadline.wait != seconds(begin - now_) || n_missed_ != counter_.n_missed ||
          start_ + time_.at(frame_ + 1) != seconds(counter_.due))
        return false;
      if (ends_run(time_, deadline)) return n_missed_ == 1;
      now_ = begin + static_cast<std::int64_t>(below(8) == 0 ? below(3) : 0);  // woken late
    }
    return time_.overrun != Overrun::stop || n_missed_ == 0;
  }

 private:
  static constexpr std::int64_t ticks_a_second = 1024;
  static double seconds(std::int64_t ticks) {
    return static_cast<double>(ticks) / static_cast<double>(ticks_a_second);
  }
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  // A frame: mostly in time, sometimes exactly so or far behind; the clock may jump meanwhile.
  void take_time() {
    const auto length = static_cast<std::uint64_t>(counter_.length);
    const std::uint64_t kind = below(8);
    const std::uint64_t most = kind == 0 ? 4 * length : kind < 3 ? 2 * length : length + 1;
    now_ += static_cast<std::int64_t>(kind == 3 ? length : below(most));
    if (below(8) == 0) now_ += static_cast<std::int64_t>(below(8 * length)) - 4 * counter_.length;
  }

  std::mt19937_64 random_;
  SceneTime time_;
  std::int64_t frame_ = 0, now_ = 0, n_missed_ = 0;
  double start_ = 0;
  Counter counter_;
};

TEST(Deadline, agrees_with_a_counter_on_random_scripts_with_clocks_that_jump) {
  constexpr std::uint64_t n_scripts = 100000;
  for (const Overrun overrun : all_overruns)
    for (std::uint64_t seed = 0; seed < n_scripts; ++seed)
      ASSERT_TRUE(Script(seed, overrun).agrees())
          << "seed " << seed << ", policy " << static_cast<int>(overrun);
}

// However quickly the frame was computed: outputs may have taken the time.
TEST(Deadline, that_is_past_counts_as_missed_in_real_time_alone) {
  const auto run = block_of("hex8", 2);
  Simulation& s = *run->s;
  s.start_seconds = monotonic_seconds() - 10;
  s.frame = 1;
  EXPECT_EQ(wait_for_deadline(s).late, 0);
  EXPECT_EQ(s.log.n_deadlines_missed, 0);
  s.scene.time.pace = Pace::real_time;
  wait_for_deadline(s);
  EXPECT_GT(wait_for_deadline(s).late, 9);
  EXPECT_EQ(s.log.n_deadlines_missed, 2);
}

TEST(Deadline, that_moves_takes_the_clock_of_the_run_along) {
  const auto run = block_of("hex8", 2);
  Simulation& s = *run->s;
  s.scene.time.pace = Pace::real_time;
  s.scene.time.overrun = Overrun::shift;
  s.scene.time.frame_rate = 1;
  start_clock(s);
  s.start_seconds -= 1000;
  s.frame = 1;
  wait_for_deadline(s);
  EXPECT_LT(std::abs(s.start_seconds + 1 - monotonic_seconds()), 900);  // of 999
  EXPECT_EQ(s.log.n_deadlines_missed, 1);
}

TEST(Deadline, that_is_missed_changes_no_bit_of_the_state) {
  const auto digest_of = [](Pace pace, Overrun overrun) {
    const auto run = block_of("hex8", 2);
    Simulation& s = *run->s;
    s.scene.time.pace = pace;
    s.scene.time.overrun = overrun;
    for (int k = 0; k < 3; ++k) {
      run_frame(s, run->outputs);
      start_clock(s);
      s.start_seconds -= 1;
      wait_for_deadline(s);
    }
    EXPECT_EQ(s.log.n_deadlines_missed, pace == Pace::fast ? 0 : 3);
    return state_digest(s);
  };
  const std::uint64_t fast = digest_of(Pace::fast, Overrun::catch_up);
  for (const Overrun overrun : all_overruns)
    EXPECT_EQ(digest_of(Pace::real_time, overrun), fast) << static_cast<int>(overrun);
}

TEST(Deadline, that_is_missed_is_told_with_frame_lateness_and_the_longest_phase) {
  const auto run = block_of("hex8", 2);
  Simulation& s = *run->s;
  s.frame = 7;
  s.log.rows.resize(1);
  s.log.rows[0].latency = 0.25;
  s.timers.add(phase_force, 100);
  const PhaseTotals before = s.timers.totals();
  s.timers.add(phase_force, 0.01);
  s.timers.add(phase_output, 0.2);
  s.scene.checkpoint.every = 0;
  const std::string text =
      "frame 7 was done 1.5 ms after its deadline, and overrun is \"stop\": of "
      "its 250 ms \"output\" took most, 200 ms";
  EXPECT_EQ(missed_text(s, {.late = 0.0015}, before), text);
  s.scene.checkpoint.every = 1;
  EXPECT_EQ(missed_text(s, {.late = 0.0015}, before), text + "; --resume goes on behind it");
}

}  // namespace
}  // namespace trocar
