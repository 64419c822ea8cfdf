#include "cutting/cut_hits.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "cutting_tet.h"
#include "known_positions.h"

namespace trocar {
namespace {

using namespace cutting_test;

Mesh box() {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, BoxElements::tet4_kuhn);
  jitter(mesh, 0.2, 2);
  return mesh;
}

void add_hits(const Mesh& mesh, CutIndex& index, std::span<const Vec3> x, const BladeSweep& sweep,
              CutStroke& stroke) {
  KnownPositions positions(mesh, x);
  trocar::add_hits(mesh, index, positions, sweep, stroke);
}

BladeSweep sweep_of(const Blade& blade, double from, double to, const Vec3& normal) {
  return {blade(from), blade(to), normal};
}

TEST(AddHits, finds_all_edges_that_a_plane_crosses_for_all_their_elements) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  const Vec3 centre(0.5, 0.45, 0.52), normal = Vec3(1, 0.4, -0.3).normalized();
  CutStroke stroke;
  add_hits(mesh, index, mesh.X, sweep_of(plane_blade(centre, normal, 2), 0, 1, normal), stroke);
  std::set<std::pair<std::int32_t, std::int32_t>> found, expected;
  for (const CutHit& hit : stroke.hit) found.insert(hit.key());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (std::int32_t k = 0; k < 6; ++k) {
      const Vec3& a = mesh.X[mesh.corners(e)[tet_edges[std::size_t(k)][0]]];
      const Vec3& b = mesh.X[mesh.corners(e)[tet_edges[std::size_t(k)][1]]];
      if ((normal.dot(a - centre) > 0) != (normal.dot(b - centre) > 0)) expected.insert({e, k});
    }
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(found, expected);
  for (const CutHit& hit : stroke.hit) {
    EXPECT_NEAR(normal.dot(hit.X - centre), 0, 1e-14);  // rounding
    EXPECT_NEAR((hit.N - normal).norm(), 0, 1e-13);
  }
}

TEST(AddHits, finds_in_small_steps_what_it_finds_in_one) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  const Vec3 centre(0.5, 0.45, 0.52), normal = Vec3(1, 0.4, -0.3).normalized();
  const Blade blade = plane_blade(centre, normal, 2);
  CutStroke one, many;
  add_hits(mesh, index, mesh.X, sweep_of(blade, 0, 1, normal), one);
  for (int k = 0; k < 60; ++k)
    add_hits(mesh, index, mesh.X, sweep_of(blade, k / 60.0, (k + 1) / 60.0, normal), many);
  ASSERT_EQ(one.hit.size(), many.hit.size());
  for (std::size_t k = 0; k < one.hit.size(); ++k) {
    EXPECT_EQ(one.hit[k].key(), many.hit[k].key());
    EXPECT_EQ(one.hit[k].is_first_plus, many.hit[k].is_first_plus);
  }
}

// Rigidly, from outside the body, in 60 frames.
TEST(AddHits, finds_where_tissue_moves_onto_an_edge_what_the_edge_finds_moving_alone) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  const Vec3 centre(0.5, 0.45, 0.52), normal = Vec3(1, 0.4, -0.3).normalized();
  const Blade blade = plane_blade(centre, normal, 2);
  const Vec3 way = blade(1)[0] - blade(0)[0];
  CutStroke moving;
  add_hits(mesh, index, mesh.X, sweep_of(blade, 0, 1, normal), moving);
  for (const double share : {0.0, 0.5}) {  // of the blade in the motion
    CutStroke met;
    for (int k = 0; k < 60; ++k) {
      std::vector<Vec3> x = mesh.X;
      for (Vec3& p : x) p -= (1 - share) * (k + 1) / 60.0 * way;
      BladeSweep sweep = sweep_of(blade, share * k / 60.0, share * (k + 1) / 60.0, normal);
      sweep.tissue_way.assign(sweep.before.size(), -(1 - share) / 60 * way);
      add_hits(mesh, index, x, sweep, met);
    }
    ASSERT_EQ(met.hit.size(), moving.hit.size()) << share;
    for (std::size_t k = 0; k < met.hit.size(); ++k) {
      EXPECT_EQ(met.hit[k].key(), moving.hit[k].key());
      EXPECT_EQ(met.hit[k].is_first_plus, moving.hit[k].is_first_plus);
    }
    EXPECT_TRUE(met.rim.empty());
    EXPECT_NEAR(met.swept, way.norm(), 1e-12) << share;  // rounding of 60 steps of 4 / 60
  }
}

// An edge that stands in the body, which sways by a millionth of itself.
TEST(AddHits, takes_up_nothing_while_an_edge_rests_and_what_has_added_up_then) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  const Blade blade = straight_blade({0.5, 0.45, -1}, {0.5, 0.45, 2}, Vec3::Zero(), 30);
  const BladeSweep rest = sweep_of(blade, 0, 0, Vec3::UnitX());
  const auto moved = [&](double y) {
    std::vector<Vec3> x = mesh.X;
    for (Vec3& p : x) p.y() += y;
    return x;
  };
  CutStroke stroke;
  for (int k = 0; k < 20; ++k)
    add_hits(mesh, index, moved(k % 2 == 0 ? 1e-6 : -1e-6), rest, stroke);
  EXPECT_TRUE(stroke.hit.empty());
  EXPECT_EQ(stroke.swept, 0);
  for (int k = 0; k < 30; ++k) add_hits(mesh, index, moved(-1e-4 * k), rest, stroke);
  EXPECT_NEAR(stroke.swept, 29e-4 + 1e-6, 1e-3 * stroke.mean_edge);  // the rest is yet to come
  EXPECT_GT(stroke.swept, 0);
}

TEST(AddHits, gives_the_crossing_in_the_reference_of_a_deformed_body) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  Mat3 F;
  F << 1.2, 0.3, 0, -0.1, 0.9, 0.2, 0.1, 0, 1.1;
  std::vector<Vec3> x;
  for (const Vec3& X : mesh.X) x.push_back(F * X);
  const Vec3 N = Vec3(0.2, 1, 0.1).normalized(), C(0.5, 0.5, 0.5);
  const Vec3 n = (F.inverse().transpose() * N).normalized();  // the plane N, C as it lies in x
  CutStroke stroke;
  add_hits(mesh, index, x, sweep_of(plane_blade(F * C, n, 3), 0, 1, n), stroke);
  EXPECT_GT(stroke.hit.size(), 100U);
  for (const CutHit& hit : stroke.hit) {
    EXPECT_NEAR(N.dot(hit.X - C), 0, 1e-13);  // rounding
    EXPECT_NEAR((hit.N - N).norm(), 0, 1e-12);
  }
}

TEST(AddHits, takes_a_crossing_back_if_the_blade_comes_back_from_the_other_side) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  const Vec3 normal = Vec3::UnitX();
  CutStroke stroke;
  const Blade there = plane_blade({0.55, 0.5, 0.5}, normal, 2);
  add_hits(mesh, index, mesh.X, sweep_of(there, 0, 1, normal), stroke);
  EXPECT_FALSE(stroke.hit.empty());
  add_hits(mesh, index, mesh.X, sweep_of(there, 0, 1, -normal), stroke);
  EXPECT_TRUE(stroke.hit.empty());
}

TEST(AddHits, leaves_no_gap_where_the_body_slips_between_two_bands) {
  const Mesh mesh = box();
  CutIndex index = index_of(mesh);
  const Vec3 normal = Vec3::UnitX();
  const Blade blade = plane_blade({0.55, 0.5, 0.5}, normal, 1);
  CutStroke still, slipping;
  add_hits(mesh, index, mesh.X, sweep_of(blade, 0, 1, normal), still);
  for (int k = 0; k < 20; ++k) {
    std::vector<Vec3> x = mesh.X;  // to and fro along the cut by a third of an edge
    const Vec3 shift = (k % 2 == 0 ? 0.08 : 0.0) * Vec3(0, 1, 1);
    for (Vec3& p : x) p += shift;
    add_hits(mesh, index, x, sweep_of(blade, k / 20.0, (k + 1) / 20.0, normal), slipping);
  }
  EXPECT_EQ(slipping.hit.size(), still.hit.size());
}

}  // namespace
}  // namespace trocar
