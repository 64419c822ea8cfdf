#include "engine/cut_along_tip.h"

#include <gtest/gtest.h>

#include "engine/simulation.h"
#include "engine_plate.h"
#include "engine_started.h"

namespace trocar {
namespace {

int n_pieces_along(const std::vector<std::pair<double, double>>& points) {
  const auto started = built(plate_text(points));
  Simulation& s = *started->s;
  for (int frame = 0; frame < 100; ++frame) run_frame(s, started->outputs);
  return s.n_pieces;
}

// Half through the plate, and then all through it: drawn back in the slit, or lifted and put into
// it once more, on its line or 0.5 mm beside.
TEST(CutAlongTip, goes_on_from_the_end_of_its_slit_in_a_plate) {
  const auto path = [](double x, double aside, bool is_lifted) {
    const std::string first = key(0.05, x, -6, 0) + key(0.5, x, 22, 0);
    const std::string back =
        is_lifted ? key(0.6, x, 22, 20) + key(0.7, x + aside, -6, 20) + key(0.75, x + aside, -6, 0)
                  : key(0.8, x, 8, 0);
    return facing(first + back + key(1.4, x + aside, 46, 0), "[0, 1, 0]");
  };
  for (const double x : {26.3, 33.1})
    for (const auto& [aside, is_lifted] : {std::pair{0.0, false}, {0.0, true}, {0.5, true}}) {
      const auto started = built(plate_with_keys(path(x, aside, is_lifted)));
      Simulation& s = *started->s;
      while (s.frame < 45) run_frame(s, started->outputs);
      EXPECT_EQ(s.n_pieces, 2) << x << ' ' << aside << ' ' << is_lifted;
      for (const CutRecord& stroke : s.cuts[0].strokes)
        EXPECT_EQ(stroke.figures.n_refused, 0) << x << ' ' << aside << ' ' << is_lifted;
    }
}

// Along a circle and some way on in its own slit, and around a wedge from the lower side and back
// to it in two strokes that meet at its tip: each parts the plate.
TEST(CutAlongTip, parts_a_plate_along_a_way_that_closes) {
  for (const double radius : {8.0, 10.0, 12.0, 14.0}) {
    std::vector<std::pair<double, double>> circle;
    for (int k = 0; k <= 18; ++k)
      circle.emplace_back(35 + radius * std::cos(0.4 * k), 20 + radius * std::sin(0.4 * k));
    EXPECT_EQ(n_pieces_along(circle), 2) << radius;
  }
  for (const double x : {30.0, 32.5, 35.0, 37.5}) {
    const std::string first = key(0.05, x - 9, -6, 0) + key(0.6, x, 24, 0) + key(0.7, x, 24, 20);
    const std::string then = key(0.8, x + 9, -6, 20) + key(0.85, x + 9, -6, 0);
    const auto started =
        built(plate_with_keys(facing(first + then + key(1.4, x - 0.6, 26, 0), "[0, 1, 0]")));
    Simulation& s = *started->s;
    while (s.frame < 46) run_frame(s, started->outputs);
    EXPECT_EQ(s.n_pieces, 2) << x;
  }
}

// At once, one close behind the other and one long after it, up to 0.8 mm beside.
TEST(CutAlongTip, second_scalpel_follows_the_slit_of_the_first) {
  const auto keys = [](double start, double x) {
    return facing(key(start, x, -6, 0) + key(start + 0.8, x, 46, 0), "[0, 1, 0]");
  };
  for (const double later : {0.0, 0.05, 0.1, 0.3})
    for (const double aside : {0.0, 0.3, 0.8}) {
      const auto started = built(plate_with_keys(keys(0.1, 33)) +
                                 "[[instrument]]\nkind = \"scalpel\"\nname = \"second\"\nradius = "
                                 "0.001\npath = [\n" +
                                 keys(0.1 + later, 33 + aside) + "]\n");
      Simulation& s = *started->s;
      while (s.frame < 40) run_frame(s, started->outputs);
      EXPECT_EQ(s.n_pieces, 2) << later << ' ' << aside;
      EXPECT_FALSE(s.cuts[1].strokes.empty()) << later << ' ' << aside;
      for (const CutRecord& stroke : s.cuts[1].strokes)
        EXPECT_EQ(stroke.figures.n_refused + stroke.n_edits, 0) << later << ' ' << aside;
    }
}

}  // namespace
}  // namespace trocar
