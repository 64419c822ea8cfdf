// Any number that the state is made of changes its digest, in the last bit, too.
#include "engine/state_digest.h"

#include <gtest/gtest.h>

#include <bit>

#include "engine/checkpoint.h"
#include "engine/energy_ledger.h"
#include "engine_resume.h"
#include "engine_started.h"

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

// Energies ask for forces at the end of a frame.
TEST(StateDigest, does_not_depend_on_what_a_run_tells) {
  const std::vector<std::string> viscous = {"tissue.material.prony=[{share=0.4,time='0.1 s'}]",
                                            "checkpoint.every=0"};
  const auto silent = built(resume_block_text, viscous),
             telling = built(resume_block_text, viscous);
  open_energy_ledger(*telling->s);
  while (silent->s->frame < 7) {
    run_frame(*silent->s, silent->outputs);
    run_frame(*telling->s, telling->outputs);
    EXPECT_EQ(state_digest(*telling->s), state_digest(*silent->s)) << silent->s->frame;
  }
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
