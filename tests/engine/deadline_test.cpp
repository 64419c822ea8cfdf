#include "engine/deadline.h"

#include <gtest/gtest.h>

#include "base/timers.h"
#include "engine_started.h"

namespace trocar {
namespace {

TEST(Deadline, of_a_frame_does_not_depend_on_how_late_others_were) {
  Simulation s;
  s.scene.time.frame_rate = 4;
  s.start_seconds = 100;
  s.frame = 3;
  EXPECT_EQ(left_of_frame(s, 100), 0.75);
  EXPECT_EQ(left_of_frame(s, 100.75), 0);
  EXPECT_EQ(left_of_frame(s, 102), -1.25);
}

// However quickly the frame was computed: outputs may have taken the time.
TEST(Deadline, that_is_past_counts_as_missed_in_real_time_alone) {
  const auto run = block_of("hex8", 2);
  Simulation& s = *run->s;
  s.start_seconds = monotonic_seconds() - 10;
  s.frame = 1;
  wait_for_deadline(s);
  EXPECT_EQ(s.log.n_deadlines_missed, 0);
  s.scene.time.pace = Pace::real_time;
  wait_for_deadline(s);
  wait_for_deadline(s);
  EXPECT_EQ(s.log.n_deadlines_missed, 2);
}

}  // namespace
}  // namespace trocar
