// An instrument begins outside of the body, however deep it would be inside.
#include "engine/instrument_check.h"

#include <gtest/gtest.h>

#include "engine_started.h"

namespace trocar {
namespace {

// 40 x 40 x 40 mm in cells of 5 mm, an instrument whose tip stands `height` above the bottom.
std::string block_under(const std::string& kind, double height) {
  return "[time]\nduration = \"1 s\"\n[tissue.shape]\nkind = \"box\"\nlow = [-0.02, -0.02, 0]\n"
         "high = [0.02, 0.02, 0.04]\ncells = [8, 8, 8]\nelements = \"tet4-five\"\n"
         "[tissue.material]\nyoung_modulus = 6000\n[[support]]\nregion = \"z-\"\nfix = \"xyz\"\n"
         "[[instrument]]\nkind = \"" +
         kind + "\"\npath = [ { time = 0, position = [0.001, 0.002, " + std::to_string(height) +
         "] } ]\n";
}

std::string start_refusal(const std::string& kind, double height) {
  return error_of([&] { built(block_under(kind, height)); });
}

TEST(InstrumentCheck, refuses_a_tip_at_any_depth_and_says_which) {
  for (const double depth : {0.005, 0.01, 0.015, 0.018})
    for (const std::string kind : {"probe", "grasper"}) {
      const std::string sentence = start_refusal(kind, 0.04 - depth);
      EXPECT_NE(sentence.find("instrument[0].path[0].position"), std::string::npos)
          << kind << depth << sentence;
    }
  // The shaft, with a radius of its own, counts for less than the tip.
  EXPECT_NE(start_refusal("probe", 0.022).find("reaches 0.018 m into the body"), std::string::npos)
      << start_refusal("probe", 0.022);
}

// A shaft of 150 mm that comes from above and ends 30 mm below.
TEST(InstrumentCheck, refuses_a_shaft_that_goes_through) {
  for (const std::string kind : {"probe", "grasper"})
    EXPECT_NE(start_refusal(kind, -0.03).find("into the body"), std::string::npos) << kind;
}

TEST(InstrumentCheck, lets_instruments_begin_outside_and_blades_anywhere) {
  EXPECT_EQ(start_refusal("probe", 0.05), "");
  EXPECT_EQ(start_refusal("grasper", 0.05), "");
  EXPECT_EQ(start_refusal("scissors", 0.05), "");
  EXPECT_EQ(start_refusal("scalpel", 0.05), "");
  EXPECT_EQ(start_refusal("scalpel", 0.035), "");
}

std::string warnings_of_turn(const std::string& forward) {
  testing::internal::CaptureStderr();
  built(block_under("probe", 0.05), {"instrument[0].path=[{ time = 0.1, position = [0, 0, 0.05] }, "
                                     "{ time = 0.3, position = [0, 0, 0.06], forward = [" +
                                     forward + "] }]"});
  return testing::internal::GetCapturedStderr();
}

TEST(InstrumentCheck, warns_of_turns_of_which_no_way_round_is_the_short_one) {
  EXPECT_TRUE(contains(warnings_of_turn("-1, 0, 0"),
                       "instrument[0].path[1]: \"probe\" turns by 180 degrees between its keys at "
                       "0.1 s and 0.3 s"));
  EXPECT_TRUE(contains(warnings_of_turn("-1, 0.1, 0"), "turns by 174 degrees"));
  EXPECT_EQ(warnings_of_turn("-1, 0.2, 0"), "");
}

}  // namespace
}  // namespace trocar
