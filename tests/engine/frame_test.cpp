// What a frame does once and what each of its steps does.
#include "engine/frame.h"

#include <gtest/gtest.h>

#include "allocation_count.h"
#include "engine_started.h"

namespace trocar {
namespace {

// A probe on its way into a block.
const std::string pressed_text = R"([time]
duration = "1 s"
[tissue.shape]
kind = "box"
low = ["-20 mm", "-20 mm", "0 mm"]
high = ["20 mm", "20 mm", "20 mm"]
cells = [8, 8, 4]
[solver]
stable_step = "element-bound"
[[support]]
region = "z-"
[[instrument]]
kind = "probe"
radius = "6 mm"
path = [
  { time = 0, position = [0, 0, "21 mm"] },
  { time = "0.5 s", position = [0, 0, "14 mm"] },
]
)";

std::int64_t allocations_of_frame(Started& started) {
  const std::int64_t before = n_allocations;
  run_frame(*started.s, started.outputs);
  return n_allocations - before;
}

// From the same state, so that the frame's pairs and everything else that is done once is the same.
TEST(Frame, with_contact_allocates_by_frames_and_not_by_steps) {
  const auto few = built(pressed_text), many = built(pressed_text);
  for (int k = 0; k < 8; ++k)
    for (Started* started : {few.get(), many.get()}) run_frame(*started->s, started->outputs);
  many->s->scene.solver.step_factor /= 2;
  const std::int64_t of_few = allocations_of_frame(*few), of_many = allocations_of_frame(*many);
  EXPECT_EQ(of_many, of_few);
  EXPECT_GT(many->s->log.rows.back().n_substeps, 3 * few->s->log.rows.back().n_substeps / 2);
  EXPECT_FALSE(many->s->contact->set.constraints.empty());  // it does touch
}

}  // namespace
}  // namespace trocar
