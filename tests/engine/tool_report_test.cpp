#include "engine/tool_report.h"

#include <gtest/gtest.h>

#include "engine_started.h"

namespace trocar {
namespace {

// The events of a scene in which a blade of 50 mm that points to -y goes from one place to the
// other, in a block of 20 mm that is supported below, with cells of 5 mm.
std::vector<std::string> events_of_blade(const std::string& from, const std::string& to) {
  const std::string pose = "], direction = [0, -1, 0] }";
  const auto started = built(
      "[time]\nduration = 0.1\nframe_rate = 50\n[tissue.shape]\nkind = \"box\"\nhigh = "
      "[0.02, 0.02, 0.02]\ncells = [4, 4, 4]\n[[support]]\nregion = \"z-\"\n"
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.05\npath = [{ time = 0, "
      "position = [" +
      from + pose + ", { time = 0.05, position = [" + to + pose + "]\n");
  Simulation& s = *started->s;
  while (s.frame < 5) run_frame(s, started->outputs);
  note_tools_at_end(s);
  return s.log.events;
}

std::string told_of_blade(const std::string& from, const std::string& to) {
  const std::vector<std::string> events = events_of_blade(from, to);
  return events.empty() ? "" : events.back();
}

// Of 1 mm.
TEST(IdleTools, that_leave_a_slice_at_a_support_are_told_with_its_area) {
  const std::vector<std::string> events =
      events_of_blade("-0.01, -0.02, 0.001", "0.03, -0.02, 0.001");
  ASSERT_EQ(events.size(), 2U);
  EXPECT_TRUE(contains(events[0], "leaves tissue joined in one place at (")) << events[0];
  EXPECT_TRUE(contains(events[0],
                       ", 4 cm^2: a slice thinner than some third of an element "
                       "stays with nodes of a support"))
      << events[0];
  EXPECT_TRUE(contains(events[1], "its strokes in the summary say where tissue stays joined"));
}

TEST(IdleTools, that_were_deep_in_the_tissue_are_told_with_the_reason) {
  const std::string beside_support = told_of_blade("-0.01, -0.02, 0.0001", "0.03, -0.02, 0.0001");
  EXPECT_TRUE(
      contains(beside_support, "so near to a surface, a support, an older cut or hexahedra"))
      << beside_support;
  const std::string stab = told_of_blade("0.01, 0.03, 0.008", "0.01, -0.01, 0.008");
  EXPECT_TRUE(contains(stab, "along its edge, as one that stabs")) << stab;
  const std::string half_in = told_of_blade("-0.005, -0.02, 0.008", "0.003, -0.02, 0.008");
  EXPECT_TRUE(contains(half_in, "scalpel has cut nothing: it went no farther than ")) << half_in;
  EXPECT_TRUE(contains(half_in, "a cut stays half an edge to one and a half behind")) << half_in;
}

// A way through the block, and one along its upper side that is too shallow.
TEST(IdleTools, are_told_of_strokes_that_cut_nothing_beside_others_that_did) {
  const auto key = [](double time, const std::string& position) {
    return "{ time = " + std::to_string(time) + ", position = [" + position +
           "], direction = [0, 0, -1], stop = true },\n";
  };
  const std::string through = key(0, "-0.01, 0.011, -0.002") + key(0.1, "0.03, 0.011, -0.002"),
                    away = key(0.15, "0.03, 0.005, 0.03") + key(0.2, "-0.01, 0.005, 0.03"),
                    shallow = key(0.25, "-0.01, 0.005, 0.019") + key(0.35, "0.03, 0.005, 0.019");
  for (const bool is_both : {false, true}) {
    const auto started = built(
        "[time]\nduration = 0.4\nframe_rate = 50\n[tissue.shape]\nkind = \"box\"\nhigh = "
        "[0.02, 0.02, 0.02]\ncells = [4, 4, 4]\n[[support]]\nregion = \"z-\"\n"
        "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.05\npath = [\n" +
        through + (is_both ? away + shallow : "") + "]\n");
    Simulation& s = *started->s;
    while (s.frame < 20) run_frame(s, started->outputs);
    note_tools_at_end(s);
    const auto told = std::ranges::find_if(s.log.events, [](const std::string& event) {
      return contains(event,
                      "scalpel has cut nothing in 1 of its 2 strokes, first in that of 0.3 s");
    });
    ASSERT_EQ(told != s.log.events.end(), is_both);
    if (!is_both) continue;
    const std::string before = "no more than ", behind = " mm of its edge was in the tissue";
    const std::size_t begin = told->find(before) + before.size();
    ASSERT_TRUE(contains(*told, behind)) << *told;
    EXPECT_NEAR(std::stod(told->substr(begin)), 1.1, 0.05) << *told;  // the block still swings
  }
}

// A strip of 10 x 6 mm that is held at one end, 50 mm from the scissors that close on it.
std::vector<std::string> events_of_snip(double resistance, int frame_rate) {
  const std::string pose =
      "position = [0.05, -0.014, 0.003], direction = [0, -1, 0], "
      "forward = [0, 0, 1]";
  const auto started =
      built("[time]\nduration = 1\nframe_rate = " + std::to_string(frame_rate) +
            "\n[tissue.shape]\nkind = \"box\"\nelements = \"tet4-kuhn\"\nlow = [0, -0.005, 0]\n"
            "high = [0.08, 0.005, 0.006]\ncells = [27, 4, 2]\n[tissue.material]\n"
            "young_modulus = 15000\n[solver]\nmass_damping = 10\n[cutting]\nresistance = " +
            std::to_string(resistance) +
            "\n[[support]]\nregion = \"x-\"\n[[instrument]]\nkind = \"scissors\"\n"
            "blade_length = 0.034\npath = [{ time = 0, " +
            pose + " }, { time = 0.3, " + pose + ", action = \"close\" }]\n");
  Simulation& s = *started->s;
  while (s.state.time < 0.35) run_frame(s, started->outputs);
  note_tools_at_end(s);
  return s.log.events;
}

// With 60 frames a second the edge is never found inside, with 300 it is.
TEST(IdleTools, that_push_the_tissue_out_uncut_are_told_of_the_resistance) {
  for (const int frame_rate : {60, 300}) {
    const std::vector<std::string> events = events_of_snip(20, frame_rate);
    ASSERT_FALSE(events.empty());
    EXPECT_TRUE(contains(events.back(),
                         "scissors has cut nothing: the tissue went along with its "
                         "edge on "))
        << events.back();
    EXPECT_TRUE(contains(events.back(), "cutting.resistance is more than the tissue bears there"))
        << events.back();
  }
  for (const std::string& event : events_of_snip(2, 60))
    EXPECT_FALSE(contains(event, "has cut nothing")) << event;
}

// A block of 20 mm, or a sheet, and an instrument in its middle that does nothing.
std::string told_of_resting(const std::string& shape, const std::string& kind) {
  const auto started =
      built("[time]\nduration = 0.1\nframe_rate = 50\n[tissue.shape]\nhigh = [0.02, 0.02, " +
            shape + "]\n[[support]]\nregion = \"x-\"\n[[instrument]]\nkind = \"" + kind +
            "\"\npath = [{ time = 0, position = [0.012, -0.005, 0], direction = [0, 1, 0] }]\n");
  Simulation& s = *started->s;
  run_frame(s, started->outputs);
  note_tools_at_end(s);
  return s.log.events.empty() ? "" : s.log.events.back();
}

TEST(IdleTools, that_never_could_cut_are_told_with_what_they_need) {
  const std::string of_scissors =
      told_of_resting("0.02]\nkind = \"box\"\ncells = [4, 4, 4", "scissors");
  EXPECT_TRUE(contains(of_scissors,
                       "its jaws never closed on the tissue, and open blades neither "
                       "part nor press it"))
      << of_scissors;
  const std::string of_sheet =
      told_of_resting("0]\nkind = \"rectangle\"\ncells = [5, 5, 1", "scalpel");
  EXPECT_TRUE(contains(of_sheet,
                       "its blade never met the tissue: in a plane scene it cuts where "
                       "its edge crosses z = 0"))
      << of_sheet;
}

}  // namespace
}  // namespace trocar
