#include "engine/event_log.h"

#include <gtest/gtest.h>

#include "engine_started.h"

namespace trocar {
namespace {

TEST(EventLog, has_sentences_with_their_times_and_knows_what_is_told) {
  const auto started = block_of("hex8", 2);
  Simulation& s = *started->s;
  EXPECT_FALSE(is_told(s, "slips"));
  note_event(s, 0.1234, "tissue slips out of jaws");
  warn_event(s, 2, "the step is small");
  EXPECT_EQ(s.log.events, (std::vector<std::string>{"0.123 s: tissue slips out of jaws",
                                                    "2.000 s: the step is small"}));
  EXPECT_TRUE(is_told(s, "slips"));
  EXPECT_TRUE(is_told(s, "step is"));
  EXPECT_FALSE(is_told(s, "stable"));
}

}  // namespace
}  // namespace trocar
