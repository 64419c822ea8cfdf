#include "engine/build.h"

#include <gtest/gtest.h>

#include "engine/film_studio.h"
#include "engine_resume.h"
#include "engine_started.h"

namespace trocar {
namespace {

Outputs outputs_of(Started& started) {
  return open_outputs(*started.s, started.folder.file("out"), "", nullptr);
}

TEST(Build, makes_nothing_that_a_scene_has_no_use_for) {
  for (const std::string elements : {"hex8", "tet4-kuhn"}) {
    const auto started = block_of(elements);
    Simulation& s = *started->s;
    Outputs outputs = outputs_of(*started);
    for (int frame = 0; frame < 2; ++frame) {
      EXPECT_EQ(s.contact, nullptr);
      EXPECT_TRUE(s.tools.empty() && s.holds.holds.empty() && s.holds.prescribed.empty());
      EXPECT_TRUE(s.cuts.empty() && s.cut_state.x.empty() && s.drag.node.empty());
      EXPECT_TRUE(s.corners.first.empty() && s.boxes.x.empty());  // of what a blade may meet
      EXPECT_EQ(s.energy, nullptr);
      EXPECT_TRUE(s.scratch.swept.empty() && s.scratch.middle.empty());  // of works
      EXPECT_FALSE(s.sleep);
      EXPECT_FALSE(s.local_steps);
      EXPECT_EQ(s.multirate, nullptr);
      EXPECT_FALSE(s.mass_scaling || s.added_mass);
      EXPECT_TRUE(s.loads.is_empty() && s.markers.empty() && s.view.x.empty());
      EXPECT_TRUE(outputs.slots.empty());
      EXPECT_EQ(outputs.studio, nullptr);
      run_frame(s, outputs);
    }
  }
}

// The test above would not notice otherwise.
TEST(Build, makes_what_a_scene_has_a_use_for) {
  const std::string camera = "[[camera]]\neye = [0, -1, 0]\ntarget = [0, 0, 0]\n",
                    picture = "[[output]]\nkind = \"frames\"\nfile = \"png\"\nsize = [16, 16]\n";
  const auto started = built(resume_block_text + metrics_table + camera + picture,
                             {"solver.sleep='0.3 mm'", "solver.multirate=true"});
  const Simulation& s = *started->s;
  EXPECT_NE(s.contact, nullptr);
  EXPECT_EQ(s.tools.size(), 3u);
  EXPECT_EQ(s.cuts.size(), 1u);
  EXPECT_FALSE(s.corners.first.empty() || s.boxes.x.empty());
  EXPECT_NE(s.energy, nullptr);
  EXPECT_TRUE(s.sleep);
  EXPECT_TRUE(s.local_steps);
  EXPECT_FALSE(s.holds.holds.empty());
  EXPECT_FALSE(s.view.x.empty());
  EXPECT_NE(outputs_of(*started).studio, nullptr);
}

}  // namespace
}  // namespace trocar
