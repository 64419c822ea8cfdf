// Blades that pass a support, an outer surface or an older cut by less than the mesh can show.
#include "cutting/cut_missed_slice.h"

#include <gtest/gtest.h>

#include "cutting_cube.h"
#include "known_positions.h"

namespace trocar {
namespace {

using namespace cutting_test;

const Vec3 centre = Vec3::Constant(0.5), up = Vec3::UnitZ();

void hold(Body& body, const std::function<bool(const Vec3&)>& is_there) {
  for (std::size_t i = 0; i < body.is_held.size(); ++i)
    body.is_held[i] = is_there(body.mesh.X[i]) ? 1 : 0;
}

bool is_bottom(const Vec3& X) {
  return X.z() < 1e-9;
}

// The slices that a stroke tells of; `others` gets the number of its other refusals.
std::vector<CutRefusal> told_slices(Body& body, const Blade& blade, const Vec3& normal,
                                    int* others = nullptr) {
  constexpr int n_steps = 24;
  TetCutter cutter{CutTetOptions{}};
  Ledger ledger;
  std::vector<CutRefusal> slices;
  int n_others = 0;
  for (int k = 0; k < n_steps; ++k) {
    CutFigures figures;
    KnownPositions positions(body.mesh, body.x);
    const BladeSweep sweep{blade(double(k) / n_steps), blade(double(k + 1) / n_steps), normal};
    const MeshEdit edit =
        cutter.advance(body.mesh, positions, {body.is_held}, sweep, k + 1 == n_steps, figures);
    apply(edit, figures, body, ledger);
    EXPECT_EQ(figures.refusals.size(), static_cast<std::size_t>(figures.n_refused));
    for (const CutRefusal& r : figures.refusals)
      if (r.reason == CutRefusal::slice || r.reason == CutRefusal::slice_held)
        slices.push_back(r);
      else
        ++n_others;
  }
  EXPECT_EQ(fault(body), "");
  if (others != nullptr) *others = n_others;
  return slices;
}

// All through the cube at height z.
std::vector<CutRefusal> slices_at(double z, Body& body, const Vec3& normal = up) {
  return told_slices(body, plane_blade({0.5, 0.5, z}, normal.normalized(), 1.2),
                     normal.normalized());
}

TEST(MissedSlices, beside_a_support_are_told_once_with_their_place_and_area) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double z : {0.075, 0.15, 0.3, 0.375}) {
      Body body = cube(elements);
      hold(body, is_bottom);
      const std::vector<CutRefusal> told = slices_at(z * cell, body);
      ASSERT_EQ(told.size(), 1U) << z;
      EXPECT_EQ(told[0].reason, CutRefusal::slice_held);
      EXPECT_NEAR(told[0].X.z(), z * cell, 1e-12);
      EXPECT_NEAR(told[0].area, 1, 1e-12);  // the cube's whole bottom
      EXPECT_EQ(n_pieces(body.mesh), 1);
    }
}

// An edge along x, at height z(x) of the cube, that moves along y.
Blade bent_blade(const std::function<double(double)>& z) {
  return [z](double t) {
    std::vector<Vec3> edge;
    for (int k = 0; k <= 36; ++k) {
      const double x = -0.1 + 1.2 * k / 36;
      edge.emplace_back(x, -0.1 + 1.2 * t, z(x));
    }
    return edge;
  };
}

// High in the cube at x < 0.25, down at the support at x > 0.36; in between the cut comes out
// below.
TEST(MissedSlices, are_told_where_the_same_stroke_cuts_properly_elsewhere) {
  Body body = cube();
  hold(body, is_bottom);
  const double low = 0.1 * cell;
  int n_others = 0;
  const std::vector<CutRefusal> told = told_slices(
      body, bent_blade([&](double x) { return std::clamp(0.5 - 4 * (x - 0.25), low, 0.5); }), up,
      &n_others);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(n_others, 0);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].reason, CutRefusal::slice_held);
  EXPECT_NEAR(told[0].X.z(), low, 1e-12);
  EXPECT_GT(told[0].X.x(), 0.36);
  EXPECT_LT(told[0].area, 1 - 0.36);
  EXPECT_GT(told[0].area, 1 - 0.36 - 2 * cell);
}

TEST(MissedSlices, that_do_not_hang_together_are_told_one_by_one) {
  Body body = cube();
  hold(body, is_bottom);
  const Blade roof =
      bent_blade([](double x) { return std::max(0.1 * cell, 1.5 * cell - 2 * std::abs(x - 0.5)); });
  const std::vector<CutRefusal> told = told_slices(body, roof, up);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_LT(told[0].X.x(), 0.5);
  EXPECT_GT(told[1].X.x(), 0.5);
}

TEST(MissedSlices, beside_an_older_cut_and_at_the_outer_surface_are_told) {
  for (const double jittered : {0.0, 0.1}) {
    Body body = cube(BoxElements::tet4_kuhn, jittered);
    EXPECT_TRUE(slices_at(0.5, body).empty());
    const std::vector<CutRefusal> beside = slices_at(0.5 + 0.25 * cell, body);
    ASSERT_EQ(beside.size(), 1U) << jittered;
    EXPECT_EQ(beside[0].reason, CutRefusal::slice);
    EXPECT_GT(beside[0].area, 0.7);
    EXPECT_EQ(n_pieces(body.mesh), 2);
    const std::vector<CutRefusal> shaved = slices_at(1 - 0.25 * cell, body);
    ASSERT_EQ(shaved.size(), 1U) << jittered;
    EXPECT_EQ(shaved[0].reason, CutRefusal::slice);
  }
}

TEST(MissedSlices, are_none_along_planes_of_a_grid_or_near_free_nodes_that_move) {
  for (const double z : {0.5, 0.5 + 0.1 * cell, 0.5 - 0.3 * cell, 0.5 + 0.5 * cell})
    for (const double jittered : {0.0, 0.2}) {
      Body body = cube(BoxElements::tet4_kuhn, jittered);
      EXPECT_TRUE(slices_at(z, body).empty()) << z;
      EXPECT_EQ(n_pieces(body.mesh), 2);
    }
}

TEST(MissedSlices, are_none_of_a_blade_at_the_surface_itself) {
  for (const double z : {-0.1 * cell, 0.0, 0.05 * cell, 1.0, 1 - 0.05 * cell}) {
    Body body = cube();
    hold(body, is_bottom);
    EXPECT_TRUE(slices_at(z, body).empty()) << z;
  }
}

TEST(MissedSlices, are_none_where_a_blade_comes_out_beside_held_nodes) {
  for (const double degrees : {15, 30, 45, 60, 75, 90}) {
    Body body = cube(BoxElements::tet4_kuhn, 0.2);
    hold(body, is_bottom);
    const double angle = degrees * 3.14159265358979323846 / 180;
    const Vec3 normal(-std::sin(angle), 0.1, std::cos(angle));
    EXPECT_TRUE(slices_at(0.1 * cell, body, normal).empty()) << degrees;
    EXPECT_EQ(n_pieces(body.mesh), 2) << degrees;
  }
}

TEST(MissedSlices, are_none_of_a_blade_that_stops_inside) {
  Body body = cube();
  hold(body, is_bottom);
  const Blade blade =
      straight_blade({-0.1, -0.1, 0.2 * cell}, {-0.1, 1.1, 0.2 * cell}, {0.7, 0, 0});
  EXPECT_TRUE(told_slices(body, blade, up).empty());
}

// Into a slit to the middle, then all through: half of that way is open.
TEST(MissedSlices, are_none_of_a_blade_that_comes_again_in_its_slit) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double jittered : {0.0, 0.2})
      for (int turn = 0; turn < 6; ++turn) {
        Body body = cube(elements, jittered);
        const Vec3 normal = Vec3(0.3 * std::sin(turn), 0.4 * std::cos(turn), 1).normalized();
        const Vec3 along = normal.unitOrthogonal(), way = normal.cross(along);
        const Vec3 begin = centre + 0.03 * turn * cell * up - 1.2 * (way + along);
        const auto stroke = [&](double length) {
          return told_slices(body, straight_blade(begin, begin + 2.4 * along, length * way, 16),
                             normal);
        };
        EXPECT_TRUE(stroke(1.2).empty());
        EXPECT_TRUE(stroke(2.4).empty());
        EXPECT_TRUE(stroke(2.4).empty());
        EXPECT_GE(n_pieces(body.mesh), 2);
      }
}

}  // namespace
}  // namespace trocar
