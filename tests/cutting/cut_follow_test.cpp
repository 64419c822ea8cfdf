// Two blades at once on one line.
#include "cutting/cut_follow.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar::cutting_test {
namespace {

const Vec3 normal = Vec3::UnitX();

// Through the cube's middle, half of its height deep: a slit, not a cut through.
BladeSweep sweep_at(double x, int k) {
  const auto edge = [&](int n) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 8; ++i) points.emplace_back(x, -0.1 + 1.2 * n / 30, 0.5 + 0.1 * i);
    return points;
  };
  return {.before = edge(k), .after = edge(k + 1), .normal = normal};
}

int facets_opened_by(BoxElements elements, double x, int n_blades) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, elements));
  std::vector<TetCutter> cutters;
  for (int c = 0; c < n_blades; ++c) cutters.emplace_back(CutTetOptions{}).prepare(body.mesh);
  Ledger ledger;
  for (int k = 0; k < 30; ++k)
    for (TetCutter& cutter : cutters) {
      const Mesh before = body.mesh;
      const CutterEdit edit = advance(cutter, body, sweep_at(x, k), k == 29, ledger);
      for (TetCutter& other : cutters)
        if (&other != &cutter) other.follow(before, edit);
    }
  EXPECT_EQ(fault(body), "");
  return ledger.total.n_opened_facets;
}

TEST(CutFollow, second_blade_on_the_same_line_opens_no_slit_of_its_own) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double x : {0.47, 0.5, 0.52, 0.55}) {
      const int alone = facets_opened_by(elements, x, 1);
      EXPECT_GT(alone, 40) << x;
      EXPECT_LE(facets_opened_by(elements, x, 2), 1.3 * alone) << x;
    }
}

}  // namespace
}  // namespace trocar::cutting_test
