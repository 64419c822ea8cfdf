// Pieces that several strokes cut free together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/cut_stage.h"
#include "engine/simulation.h"
#include "engine/tool_report.h"
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

// A square of 30 mm out of the middle of a plate, turned by 0.3, by four scalpels that go a cell
// beyond its corners; in mm and s.
std::string square_text(const std::string& elements) {
  constexpr double cell = 60.0 / 16, half = 15, angle = 0.3, top = 3 * cell + 10;
  std::string text =
      "[time]\nduration = 2.1\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = \"" +
      elements +
      "\"\nlow = [-0.03, -0.03, 0]\nhigh = [0.03, 0.03, 0.01125]\ncells = [16, 16, 3]\n"
      "[tissue.material]\nyoung_modulus = 10000\npoisson_ratio = 0.4\ndensity = 1000\n"
      "[solver]\nmass_damping = 30\n";
  for (const char* side : {"x-", "x+", "y-", "y+"})
    text += std::string("[[support]]\nregion = \"") + side + "\"\n";
  for (int k = 0; k < 4; ++k) {
    const double turn = angle + k * 1.5707963267948966, c = std::cos(turn), n = std::sin(turn);
    const double along = half + cell, start = 0.52 * k;
    const Vec3 from(-c * along + n * half, -n * along - c * half, 0),
        to(c * along + n * half, n * along - c * half, 0);
    const std::string forward =
        "[" + std::to_string(c) + ", " + std::to_string(n) + ", 0], stop = true";
    text +=
        "[[instrument]]\nkind = \"scalpel\"\nname = \"s" + std::to_string(k) +
        "\"\nblade_length = 0.03\npath = [\n" +
        facing((k > 0 ? key(0, from.x(), from.y(), top) : "") +
                   key(start, from.x(), from.y(), top) + key(start + 0.1, from.x(), from.y(), -4) +
                   key(start + 0.4, to.x(), to.y(), -4) + key(start + 0.5, to.x(), to.y(), top),
               forward) +
        "]\n";
  }
  return text;
}

// What strokes around it leave hanging at a corner, without a place where the blade missed tissue.
TEST(CutSeveral, tells_of_a_part_that_hangs_by_few_elements) {
  int n_told = 0;
  for (const std::string elements : {"hex8", "tet4-kuhn", "tet4-five"}) {
    const auto started = built(square_text(elements));
    Simulation& s = *started->s;
    while (s.frame < 126) run_frame(s, started->outputs);
    note_tools_at_end(s);
    const bool is_told = std::ranges::any_of(s.log.events, [](const std::string& event) {
      return event.find("hangs by few elements between cuts, at") != std::string::npos;
    });
    EXPECT_NE(s.n_pieces == 2, is_told) << elements;
    n_told += is_told ? 1 : 0;
  }
  EXPECT_GT(n_told, 0);
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
