// Pieces that several strokes cut free together.
#include <gtest/gtest.h>

#include <string>

#include "engine/cut_stage.h"
#include "engine/simulation.h"
#include "engine_plate.h"
#include "engine_started.h"

namespace trocar {
namespace {

std::string slab_text() {
  return "[time]\nduration = 4\nframe_rate = 30\n[tissue.shape]\nkind = \"box\"\nelements = "
         "\"tet4-five\"\nhigh = [0.0456, 0.053, 0.0065]\ncells = [17, 20, "
         "2]\n[tissue.material]\nyoung_modulus = 3000\npoisson_ratio = 0.4\n[solver]\n"
         "mass_damping = 5\n[cutting]\nresistance = 5\n[[support]]\nregion = \"x-\"\n[[support]]\n"
         "region = \"x+\"\n[[support]]\nregion = \"y-\"\n[[support]]\nregion = \"y+\"\n";
}

// Into the slab at (x, y), along `way` and out again, from `time` on; all in mm and s.
std::string stroke(double time, double x, double y, double way_x, double way_y) {
  const double far_x = x + way_x, far_y = y + way_y;
  const std::string forward = way_x != 0 ? (way_x > 0 ? "[1, 0, 0]" : "[-1, 0, 0]")
                                         : (way_y > 0 ? "[0, 1, 0]" : "[0, -1, 0]");
  return facing(key(time, x, y, 11.5) + key(time + 0.1, x, y, -12) +
                    key(time + 0.27, far_x, far_y, -12) + key(time + 0.38, far_x, far_y, 11.5),
                forward);
}

// Soft tissue goes along with the blade and springs back, so that the slits' lips overlap.
TEST(CutSeveral, four_strokes_of_a_scalpel_free_the_piece_between_them) {
  const std::string scalpel =
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.0305\nradius = 0.001\npath = [\n" +
      stroke(0.03, 4.6, 17.9, 33.4, 0) + stroke(0.56, 31.3, 11.2, 0, 33.4) +
      stroke(1.09, 38, 37.9, -33.4, 0) + stroke(1.63, 11.2, 44.6, 0, -33.4) + "]\n";
  const auto started = built(slab_text() + scalpel);
  Simulation& s = *started->s;
  while (s.frame < 63) run_frame(s, started->outputs);
  EXPECT_EQ(s.n_pieces, 2);
}

// Along y, from its side of the block on, to 3 mm beyond the middle and out upwards.
std::string scalpel_from(bool is_low, double start, double x) {
  const double from = is_low ? -6 : 36, to = is_low ? 18 : 12;
  return "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.02\nradius = 0.0005\nname = \"" +
         std::string(is_low ? "low" : "high") + "\"\npath = [\n" +
         facing(
             key(start, x, from, -3) + key(start + 0.45, x, to, -3) + key(start + 0.75, x, to, 37),
             is_low ? "[0, 1, 0]" : "[0, -1, 0]") +
         "]\n";
}

TEST(CutSeveral, two_scalpels_that_meet_part_the_block) {
  for (const std::string elements : {"tet4-kuhn", "hex8"})
    for (const double later : {0.0, 0.15})
      for (const double aside : {0.0, 0.5}) {
        const auto started = built(
            "[time]\nduration = 2\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = \"" +
            elements +
            "\"\nhigh = [0.06, 0.03, 0.012]\ncells = [20, 10, 4]\n[tissue.material]\n"
            "young_modulus = 6000\npoisson_ratio = 0.4\n[solver]\nmass_damping = 20\n"
            "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n" +
            scalpel_from(true, 0.05, 31.1) + scalpel_from(false, 0.05 + later, 31.1 + aside));
        Simulation& s = *started->s;
        while (s.frame < 57) run_frame(s, started->outputs);
        EXPECT_EQ(s.n_pieces, 2) << elements << ' ' << later << ' ' << aside;
      }
}

}  // namespace
}  // namespace trocar
