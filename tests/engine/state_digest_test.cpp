// Any number that the state is made of changes its digest, in the last bit, too.
#include "engine/state_digest.h"

#include <gtest/gtest.h>

#include <bit>

#include "engine/checkpoint.h"
#include "engine_resume.h"
#include "engine_started.h"
#include "solver/history.h"

namespace trocar {
namespace {

// After a while, with nodes that are held.
std::unique_ptr<Started> viscous_and_held(const std::string& elements) {
  auto run = built(resume_block_text, {"tissue.material.prony=[{share=0.4,time='0.1 s'}]",
                                       "tissue.shape.elements=" + elements, "checkpoint.every=0"});
  while (run->s->frame < 7) run_frame(*run->s, run->outputs);
  EXPECT_FALSE(run->s->holds.holds.empty());
  return run;
}

void expect_counts(Simulation& s, double& number, const std::string& name) {
  const double value = number;
  const std::uint64_t digest = state_digest(s);
  number = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1);
  EXPECT_NE(state_digest(s), digest) << name;
  number = value;
  EXPECT_EQ(state_digest(s), digest) << name;
}

TEST(StateDigest, changes_with_places_motion_and_time) {
  const auto run = viscous_and_held("tet4-five");
  Simulation& s = *run->s;
  expect_counts(s, s.mesh.X.back()[1], "X");
  expect_counts(s, s.state.u[3], "u");
  expect_counts(s, s.state.v.back(), "v");
  expect_counts(s, s.state.time, "time");
  expect_counts(s, s.state.last_dt, "dt");
  expect_counts(s, s.state.history_time, "history_time");
}

// Of an element at the beginning and at the end of each list: the first and the last of its
// numbers, which of one-point hexahedra is one of the hourglass displacements.
TEST(StateDigest, changes_with_the_history_of_an_element) {
  for (const std::string elements : {"tet4-five", "hex8"}) {
    const auto run = viscous_and_held(elements);
    Simulation& s = *run->s;
    for (const ElementBlocks& blocks : s.model.blocks) {
      const std::int64_t lanes = blocks.lanes, width = history_width(blocks);
      ASSERT_GT(width, 0);
      for (const std::int64_t e : {std::int64_t{0}, std::int64_t{blocks.n_elements} - 1}) {
        double* const of_element =
            &s.state.history[blocks.first_history + e / lanes * width * lanes + e % lanes];
        expect_counts(s, of_element[0], elements);
        expect_counts(s, of_element[(width - 1) * lanes], elements);
      }
    }
  }
}

TEST(StateDigest, changes_with_what_is_held_and_by_whom) {
  const auto run = viscous_and_held("tet4-five");
  Simulation& s = *run->s;
  const std::uint64_t digest = state_digest(s);
  expect_counts(s, s.holds.holds.front().offset[2], "offset");
  const auto expect_new = [&](const auto& change) {
    const Holds before = s.holds;
    change(s.holds);
    EXPECT_NE(state_digest(s), digest);
    s.holds = before;
  };
  expect_new([](Holds& h) { h.holds.pop_back(); });
  expect_new([](Holds& h) { ++h.holds.front().tool; });
  expect_new([](Holds& h) { ++h.holds.front().support; });
  expect_new([](Holds& h) { ++h.holds.back().node; });
  for (std::size_t k = 0; k < s.holds.is_open.size(); ++k)
    expect_new([&](Holds& h) { h.is_open[k] = h.is_open[k] == 0 ? 1 : 0; });
  EXPECT_EQ(state_digest(s), digest);
}

TEST(StateDigest, is_that_of_the_run_that_is_resumed) {
  for (const std::string elements : {"tet4-five", "hex8"}) {
    const auto run = viscous_and_held(elements);
    Communicator alone;
    const auto resumed = build(run->loaded, alone);
    EXPECT_NE(state_digest(*resumed), state_digest(*run->s));
    restore_checkpoint(take_checkpoint(*run->s), *resumed);
    EXPECT_EQ(state_digest(*resumed), state_digest(*run->s));
  }
}

}  // namespace
}  // namespace trocar
