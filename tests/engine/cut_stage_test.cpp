#include "engine/cut_stage.h"

#include "engine/simulation.h"
#include "engine_started.h"

namespace trocar {
namespace {

std::string key(double time, double x, double y, double z) {
  const auto mm = [](double a) { return "\"" + std::to_string(a) + " mm\""; };
  return "{ time = " + std::to_string(time) + ", position = [" + mm(x) + ", " + mm(y) + ", " +
         mm(z) + "], direction = [0, 0, -1] },\n";
}

// A plate of 70 x 40 mm, 20 x 16 cells; the scalpel's tip goes along the points [mm] at 50 mm/s.
std::string plate_text(const std::vector<std::pair<double, double>>& points) {
  std::string text =
      "[time]\nduration = 4\n[tissue]\nthickness = 0.005\n[tissue.shape]\nkind = \"rectangle\"\n"
      "high = [0.07, 0.04, 0]\ncells = [20, 16, 1]\n[solver]\nmass_damping = 20\n"
      "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n"
      "[[instrument]]\nkind = \"scalpel\"\nradius = 0.001\npath = [\n";
  double time = 0.1;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [x, y] = points[k];
    if (k > 0) time += std::hypot(x - points[k - 1].first, y - points[k - 1].second) / 50;
    text += key(time, x, y, 0);
  }
  return text + key(time + 0.1, points.back().first, points.back().second, 20) + "]\n";
}

int n_opened(const std::vector<std::pair<double, double>>& points) {
  const auto started = built(plate_text(points));
  Simulation& s = *started->s;
  for (int frame = 0; frame < 60; ++frame) run_frame(s, started->outputs);
  int n = 0;
  for (const CutRecord& stroke : s.cuts[0].strokes) n += stroke.n_opened_facets;
  return n;
}

// In one edit these opened 6, 13 and 14.
TEST(CutStage, sharp_bend_takes_no_edges_from_its_legs) {
  const auto check = [](double from, double bend, double to) {
    const std::pair<double, double> a{45, from}, b{bend, 16}, c{45, to};
    EXPECT_GE(n_opened({a, b, c}), n_opened({a, b}) + n_opened({b, c})) << bend << " " << to;
  };
  check(14, 24, 22);
  check(14, 18, 30);
  check(14, 18, 26);
}

}  // namespace
}  // namespace trocar
