#include "cutting/cut_carry.h"

#include <gtest/gtest.h>

#include <numeric>

#include "mesh/generate.h"

namespace trocar {
namespace {

// A box of 8 x 4 x 4 mm in cells of 1 mm whose tissue moves affinely between two frames, and a
// blade's edge along z at (x, 2 mm).
struct Case {
  Mesh mesh = make_box(Vec3::Zero(), Vec3(8e-3, 4e-3, 4e-3), {8, 4, 4}, BoxElements::tet4_kuhn);
  std::vector<std::int32_t> all = std::vector<std::int32_t>(mesh.element_type.size());
  CutStroke stroke;
  Mat3 A = Mat3::Identity();
  Vec3 shift{-0.7e-3, 0.1e-3, 0.2e-3};

  Case() {
    std::iota(all.begin(), all.end(), 0);
    stroke.mean_edge = 1.2e-3;
    A << 1.05, 0.02, 0, -0.01, 0.97, 0.03, 0, 0.01, 1.01;
  }
  Vec3 moved(const Vec3& X) const { return A * X + shift; }
  BladeSweep at(double x, std::vector<double> z) const {
    BladeSweep sweep;
    for (const double height : z) sweep.after.emplace_back(x, 2e-3, height);
    sweep.before = sweep.after;
    return sweep;
  }
  void remember(const BladeSweep& sweep, const std::vector<std::int32_t>& near) {
    CutIndex index;
    update_index(mesh, index);
    remember_edge(mesh, index, mesh.X, sweep, near, stroke);
  }
  // Where points of the edge at `x` are after the tissue has moved.
  std::vector<Vec3> carried(double x, const std::vector<double>& z,
                            const std::vector<std::int32_t>& near) {
    remember(at(x, z), near);
    std::vector<Vec3> now;
    for (const Vec3& X : mesh.X) now.push_back(moved(X));
    return carry_edge(mesh, now, at(x, z), stroke).before;
  }
};

TEST(CarryEdge, takes_points_inside_along_with_the_tissue) {
  Case c;
  const std::vector<double> z = {0.5e-3, 1.7e-3, 3.9e-3};
  const std::vector<Vec3> before = c.carried(3.3e-3, z, c.all);
  for (std::size_t k = 0; k < z.size(); ++k)
    EXPECT_LT((before[k] - c.moved({3.3e-3, 2e-3, z[k]})).norm(), 1e-15) << k;
}

// An element before the face x = 0, of tissue that is stretched threefold along x: the blade keeps
// its distance, where the element's strain, continued to the blade, would take it 2 mm away.
TEST(CarryEdge, takes_points_beside_the_body_along_with_its_surface) {
  Case c;
  c.A = Vec3(3, 1, 1).asDiagonal();
  const std::vector<double> z = {0.5e-3, 1.7e-3, 3.4e-3};
  const std::vector<Vec3> before = c.carried(-1e-3, z, c.all);
  for (std::size_t k = 0; k < z.size(); ++k)
    EXPECT_LT((before[k] - Vec3(-1e-3, 2e-3, z[k]) - c.shift).norm(), 1e-15) << k;
}

TEST(CarryEdge, lets_points_far_from_the_body_follow_the_nearest_other_one) {
  Case c;
  const std::vector<double> z = {2e-3, 12e-3, 30e-3};
  const std::vector<Vec3> before = c.carried(3.3e-3, z, c.all);
  const Vec3 X(3.3e-3, 2e-3, 2e-3), way = c.moved(X) - X;
  for (std::size_t k = 0; k < z.size(); ++k)
    EXPECT_LT((before[k] - Vec3(3.3e-3, 2e-3, z[k]) - way).norm(), 1e-15);
}

// In tissue that has just been met, and where no point is near it.
TEST(CarryEdge, follows_the_tissue_that_it_is_told_of_while_it_remembers_none) {
  Case c;
  BladeSweep sweep = c.at(-9e-3, {1e-3, 2e-3});
  sweep.tissue_way = {{1e-3, 0, 0}, {0, 2e-3, 0}};
  for (const bool is_known : {false, true}) {
    if (is_known) c.remember(sweep, c.all);
    const std::vector<Vec3> before = carry_edge(c.mesh, c.mesh.X, sweep, c.stroke).before;
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(before[k], Vec3(sweep.before[k] + sweep.tissue_way[k])) << is_known;
  }
}

// An edge that seems to begin inside is at the rim of the stroke only if it is not right below the
// surface.
TEST(CarryEdge, tells_a_begin_in_the_tissue_from_one_at_its_surface) {
  for (const auto& [x, is_rim] : {std::pair{0.2e-3, false}, {2e-3, true}}) {
    Case c;
    c.stroke.mean_edge = 2e-3;
    c.remember(c.at(x, {-1e-3, 5e-3}), c.all);
    EXPECT_EQ(!c.stroke.rim.empty(), is_rim) << x;
  }
}

// As when the tissue has run from the blade and the band meets no element.
TEST(CarryEdge, keeps_the_element_of_the_last_frame_while_the_band_meets_none) {
  Case c;
  c.remember(c.at(0.2e-3, {1e-3, 2e-3}), c.all);
  const std::vector<Vec3> before = c.carried(-0.5e-3, {1e-3, 2e-3}, {});
  const double strain = 0.06;
  EXPECT_LT((before[0] - c.moved({-0.5e-3, 2e-3, 1e-3})).norm(), strain * 0.5e-3);
}

}  // namespace
}  // namespace trocar
