// Strips that a blade leaves out on its way through a body.
#include "cutting/cut_missed.h"

#include <gtest/gtest.h>

#include <random>

#include "cutting_cube.h"
#include "known_positions.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr double blade_middle = 0.53;

// How a stroke ends.
struct Outcome {
  int n_pieces = 0;
  double lowest = 1;  // node of a lip
  std::vector<CutRefusal> refusals;
};

// The blade's edge at height z on its way down through a unit cube.
std::vector<Vec3> edge_at(double z) {
  std::vector<Vec3> points;
  for (int k = 0; k <= 8; ++k)
    points.emplace_back(blade_middle + 0.2 * (z - 0.5), -0.2 + 0.175 * k, z);
  return points;
}

// One stroke along legs between two heights each, in steps of 0.4 cells; from leg to leg the blade
// goes without a cut.
Outcome cut_along_legs(const std::vector<std::array<double, 2>>& legs) {
  Body body = cube(BoxElements::tet4_kuhn, 0.2);
  TetCutter cutter{CutTetOptions{}};
  Outcome outcome;
  for (const auto& [from, to] : legs) {
    const bool is_end = from == legs.back()[0] && to == legs.back()[1];
    const int n = int(std::ceil(std::abs(from - to) / (0.4 * cell)));
    for (int k = 0; k < n; ++k) {
      CutFigures figures;
      Ledger ledger;
      const BladeSweep sweep{edge_at(from + (to - from) * k / n),
                             edge_at(from + (to - from) * (k + 1) / n),
                             Vec3(1, 0, -0.2).normalized()};
      KnownPositions positions(body.mesh, body.x);
      const MeshEdit edit = cutter.advance(body.mesh, positions, {body.is_held}, sweep,
                                           is_end && k + 1 == n, figures);
      apply(edit, figures, body, ledger);
      outcome.refusals.insert(outcome.refusals.end(), figures.refusals.begin(),
                              figures.refusals.end());
    }
  }
  EXPECT_EQ(fault(body), "");
  outcome.n_pieces = n_pieces(body.mesh);
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e)
    for (int f = 0; f < 4; ++f)
      if ((body.mesh.cut_facets[std::size_t(e)] >> f & 1) != 0)
        for (const int c : facet_corners(ElementType::tet4, f))
          if (c >= 0)
            outcome.lowest = std::min(outcome.lowest, body.mesh.X[body.mesh.corners(e)[c]].z());
  return outcome;
}

// From above the cube to below it but for what lies between `top` and `bottom`.
Outcome cut_all_but(double top, double bottom) {
  return cut_along_legs({{1.2, top}, {bottom, -0.2}});
}

TEST(MissedPlaces, are_none_behind_a_blade_that_leaves_nothing_out) {
  const Outcome outcome = cut_all_but(0.5, 0.5);
  EXPECT_EQ(outcome.n_pieces, 2);
  EXPECT_TRUE(outcome.refusals.empty());
}

// Wherever it stops within its elements. It has parted no more than it has passed.
TEST(MissedPlaces, are_none_of_a_blade_that_draws_back_in_its_slit) {
  for (const double deepest : {0.62, 0.56, 0.5, 0.47, 0.4, 0.33, 0.28}) {
    const Outcome outcome = cut_along_legs({{1.2, deepest}, {deepest, 1.2}});
    EXPECT_EQ(outcome.n_pieces, 1);
    EXPECT_TRUE(outcome.refusals.empty()) << deepest << ": " << outcome.refusals.size();
    EXPECT_GT(outcome.lowest, deepest - 0.05 * cell);  // nodes slide along the surface
    EXPECT_LT(outcome.lowest, deepest + 1.5 * std::sqrt(3) * cell);
  }
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

TEST(MissedPlaces, are_none_where_a_blade_stops_in_the_tissue) {
  for (const double end : {0.62, 0.5, 0.4, 0.33, 0.2, 0.1}) {
    const Outcome outcome = cut_along_legs({{1.2, end}});
    EXPECT_EQ(outcome.n_pieces, 1);
    EXPECT_TRUE(outcome.refusals.empty()) << end << ": " << outcome.refusals.size();
  }
}

// Straight strokes from side to side, the blade's lower end in the body: in a mesh without a grid
// elements reach farther from the rim than a mean edge.
TEST(MissedPlaces, are_none_above_the_rim_of_a_stroke_in_an_unstructured_mesh) {
  const Mesh mesh = read_mesh(TROCAR_SOURCE_DIR "/bench/meshes/box_delaunay.msh", 1);  // unit cube
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(0.3, 0.7);
  for (int trial = 0; trial < 24; ++trial) {
    const double y = within(random), low = within(random);
    Body body(mesh);
    TetCutter cutter{CutTetOptions{}};
    const Ledger ledger = cut(body, straight_blade({-0.05, y, low}, {-0.05, y, 1.05}, {1.1, 0, 0}),
                              Vec3(0, 1, 0), 20, cutter);
    EXPECT_EQ(fault(body), "");
    EXPECT_GT(ledger.total.n_opened_facets, 20) << trial;
    for (const CutRefusal& refusal : ledger.total.refusals)
      ADD_FAILURE() << trial << ": " << (refusal.X.z() - low) / mean_edge_length(mesh)
                    << " mean edges above the rim";
  }
}

TEST(MissedPlaces, are_reported_of_a_blade_that_stops_in_the_tissue_beyond_them) {
  const double low = 0.67, high = 0.67 + 1.5 * cell;
  const Outcome outcome = cut_along_legs({{1.2, high}, {low, 0.1}});
  EXPECT_FALSE(outcome.refusals.empty());
  for (const CutRefusal& refusal : outcome.refusals) {
    EXPECT_GT(refusal.X.z(), low - std::sqrt(3) * cell);
    EXPECT_LT(refusal.X.z(), high + std::sqrt(3) * cell);
  }
}

// A blade that leans outward by 40 degrees goes once around an axis and a twelfth more, its tip
// `beyond` the point where its ways come together. How the stroke ends in a box of 2 x 2 x 1.1 cm.
Outcome cut_cone(BoxElements elements, const Vec3& point, double beyond) {
  Body body(make_box({-0.01, -0.01, 0}, {0.01, 0.01, 0.011}, {10, 10, 6}, elements));
  TetCutter cutter{CutTetOptions{}};
  constexpr int n_steps = 52;
  constexpr double lean = 0.7, turn = 2 * M_PI / 48;
  const auto edge_at_turn = [&](int k) {
    const Vec3 down(-std::sin(lean) * std::cos(k * turn), -std::sin(lean) * std::sin(k * turn),
                    -std::cos(lean));
    std::vector<Vec3> edge;
    for (int j = 0; j <= 8; ++j) edge.emplace_back(point + (beyond - 0.016 * j / 8) * down);
    return edge;
  };
  Outcome outcome;
  for (int k = 0; k < n_steps; ++k) {
    CutFigures figures;
    Ledger ledger;
    const Vec3 ahead(-std::sin((k + 0.5) * turn), std::cos((k + 0.5) * turn), 0);
    const std::vector<Vec3> edge = edge_at_turn(k);
    const BladeSweep sweep{edge, edge_at_turn(k + 1),
                           ahead.cross(edge.front() - edge.back()).normalized()};
    KnownPositions positions(body.mesh, body.x);
    const MeshEdit edit =
        cutter.advance(body.mesh, positions, {body.is_held}, sweep, k + 1 == n_steps, figures);
    apply(edit, figures, body, ledger);
    outcome.refusals.insert(outcome.refusals.end(), figures.refusals.begin(),
                            figures.refusals.end());
  }
  outcome.n_pieces = n_pieces(body.mesh);
  return outcome;
}

// The rim is a small closed line then, within which the piece hangs: nothing was told of it, as all
// of it is near where the tip went.
TEST(Necks, of_a_piece_that_a_closed_ring_does_not_free_are_told_near_its_point) {
  const Vec3 point(0.0003, -0.0002, 0.0045);
  int n_freed = 0, n_told = 0, n_silent = 0;
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double beyond : {-0.001, 0.0, 0.001, 0.002, 0.003}) {
      const Outcome outcome = cut_cone(elements, point, beyond);
      const auto neck = std::ranges::find(outcome.refusals, CutRefusal::neck, &CutRefusal::reason);
      const bool is_told = neck != outcome.refusals.end();
      n_freed += outcome.n_pieces > 1 ? 1 : 0;
      n_told += outcome.n_pieces == 1 && is_told ? 1 : 0;
      n_silent += outcome.n_pieces == 1 && outcome.refusals.empty() ? 1 : 0;
      if (is_told) {
        EXPECT_LT((neck->X - point).norm(), 0.006) << beyond;
      }
    }
  std::printf("of 10 rings %d free their piece, %d tell of its neck\n", n_freed, n_told);
  EXPECT_GT(n_freed, 0);
  EXPECT_GT(n_told, 0);
  EXPECT_EQ(n_silent, 0);
}

}  // namespace
}  // namespace trocar
