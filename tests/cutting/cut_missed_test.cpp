// Strips that a blade leaves out on its way through a body.
#include "cutting/cut_missed.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr int n_cells = 6;
constexpr double cell = 1.0 / n_cells, middle = 0.53;

// How a stroke ends.
struct Outcome {
  int n_pieces = 0;
  std::vector<CutRefusal> refusals;
};

// The blade's edge at height z on its way down through a unit cube.
std::vector<Vec3> edge_at(double z) {
  std::vector<Vec3> points;
  for (int k = 0; k <= 8; ++k) points.emplace_back(middle + 0.2 * (z - 0.5), -0.2 + 0.175 * k, z);
  return points;
}

// From above the cube to below it in steps of 0.4 cells, but for what lies between `top` and
// `bottom`: there the blade goes from one to the other without a cut.
Outcome cut_all_but(double top, double bottom) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {n_cells, n_cells, n_cells}, BoxElements::tet4_kuhn);
  jitter(mesh, 0.2, 3);
  Body body(std::move(mesh));
  TetCutter cutter{CutTetOptions{}};
  Outcome outcome;
  const auto sweep_down = [&](double from, double to, bool is_end) {
    const int n = int(std::ceil((from - to) / (0.4 * cell)));
    for (int k = 0; k < n; ++k) {
      CutFigures figures;
      Ledger ledger;
      const BladeSweep sweep{edge_at(from + (to - from) * k / n),
                             edge_at(from + (to - from) * (k + 1) / n),
                             Vec3(1, 0, -0.2).normalized()};
      KnownPositions positions(body.mesh, body.x);
      const MeshEdit edit =
          cutter.advance(body.mesh, positions, body.is_held, sweep, is_end && k + 1 == n, figures);
      apply(edit, figures, body, ledger);
      outcome.refusals.insert(outcome.refusals.end(), figures.refusals.begin(),
                              figures.refusals.end());
    }
  };
  sweep_down(1.2, top, false);
  sweep_down(bottom, -0.2, true);
  EXPECT_EQ(fault(body), "");
  outcome.n_pieces = n_pieces(body.mesh);
  return outcome;
}

TEST(MissedPlaces, are_none_behind_a_blade_that_leaves_nothing_out) {
  const Outcome outcome = cut_all_but(0.5, 0.5);
  EXPECT_EQ(outcome.n_pieces, 2);
  EXPECT_TRUE(outcome.refusals.empty());
}

// As when tissue runs from the blade between two frames.
TEST(MissedPlaces, narrower_than_an_element_are_parted_at_the_end) {
  const Outcome outcome = cut_all_but(0.5 + 0.15 * cell, 0.5 - 0.15 * cell);
  EXPECT_EQ(outcome.n_pieces, 2);
  EXPECT_TRUE(outcome.refusals.empty());
}

TEST(MissedPlaces, that_stay_joined_are_reported_where_they_are) {
  const double half_width = 1.5 * cell;
  const Outcome outcome = cut_all_but(0.5 + half_width, 0.5 - half_width);
  EXPECT_EQ(outcome.n_pieces, 1);
  EXPECT_FALSE(outcome.refusals.empty());
  // An opening ends up to an element, sqrt(3) cells long, away from where the blade was.
  for (const CutRefusal& refusal : outcome.refusals) {
    EXPECT_LT(std::abs(refusal.X.z() - 0.5), half_width + std::sqrt(3) * cell);
    EXPECT_EQ(refusal.reason, CutRefusal::missed);
  }
}

}  // namespace
}  // namespace trocar
