#include "cutting/cut_tet.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "cutting_tet.h"
#include "known_positions.h"

namespace trocar {
namespace {

using namespace cutting_test;

Mesh block() {
  return make_box({0, 0, 0}, {1, 1, 1}, {6, 6, 6}, BoxElements::tet4_kuhn);
}

// 100 x 60 x 30 mm with 5 mm cells.
Mesh slab() {
  Mesh mesh = make_box({0, 0, 0}, {0.1, 0.06, 0.03}, {20, 12, 6}, BoxElements::tet4_five);
  jitter(mesh, 0.2, 3);
  return mesh;
}

const Vec3 along = Vec3(0.95, 0.31, 0).normalized();
const Vec3 across(-along.y(), along.x(), 0);

// 40 mm along the slab, 12 mm deep, entering through its upper face.
Blade incision() {
  const Vec3 begin(0.03, 0.022, 0);
  return straight_blade(begin + Vec3(0, 0, 0.04), begin + Vec3(0, 0, 0.018), 0.04 * along, 12);
}

TEST(TetCutter, parts_a_block_in_one_sweep) {
  Body body(block());
  const Vec3 normal = Vec3(1, 0.5, 0.2).normalized();
  const Ledger ledger = cut(body, plane_blade({0.5, 0.5, 0.5}, normal, 2), normal, 1);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(ledger.n_edits, 1);
}

TEST(TetCutter, parts_a_block_in_small_steps) {
  Body body(block());
  const Vec3 normal = Vec3(1, 0.5, 0.2).normalized();
  const Ledger ledger = cut(body, plane_blade({0.5, 0.5, 0.5}, normal, 1), normal, 30);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(fault(body), "");
  EXPECT_GT(ledger.n_edits, 5);
}

TEST(TetCutter, leaves_an_incised_body_in_one_piece_with_a_boundary_like_a_sphere) {
  Body body(slab());
  const Ledger ledger = cut(body, incision(), across, 25);
  EXPECT_EQ(n_pieces(body.mesh), 1);
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(euler_characteristic(body.mesh), 2);
  EXPECT_GE(ledger.total.n_duplicated, 6);  // lips of 40 mm have six nodes and more of 5 mm edges
}

TEST(TetCutter, makes_lips_that_lie_on_the_swept_surface) {
  Body body(slab());
  cut(body, incision(), across, 25);
  const Vec3 begin(0.03, 0.022, 0);
  const double h = mean_edge_length(body.mesh);
  std::vector<std::uint8_t> is_lip(body.mesh.X.size(), 0);
  const Surface surface = boundary_surface(body.mesh);
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    for (const std::int32_t i : surface.triangle[t])
      if (surface.is_cut[t] != 0 && body.mesh.X[i].z() > 0.03 - 1e-9) is_lip[i] = 1;
  int n_lip = 0, n_beside = 0;
  for (std::size_t i = 0; i < is_lip.size(); ++i) {
    if (is_lip[i] == 0) continue;
    ++n_lip;
    const double distance = std::abs(across.dot(body.mesh.X[i] - begin));
    EXPECT_LT(distance, 0.5 * h);
    n_beside += distance > 0.05 * h ? 1 : 0;
  }
  EXPECT_GE(n_lip, 12);
  EXPECT_LE(n_beside, 3);  // the tip, where the blade stopped within an element
}

TEST(TetCutter, conserves_mass_and_elements_and_adds_only_duplicates) {
  Body body(make_ball({0, 0, 0}, 1, 6, BoxElements::tet4_kuhn));
  const double mass_before = total_mass(body.mesh);
  const std::int32_t n_elements = body.mesh.n_elements(), n_nodes = body.mesh.n_nodes();
  const Vec3 normal = Vec3(0.3, 1, 0.4).normalized();
  const Ledger ledger = cut(body, plane_blade({0.1, 0.1, 0}, normal, 2), normal, 25);
  EXPECT_EQ(body.mesh.n_elements(), n_elements);
  EXPECT_EQ(body.mesh.n_nodes(), n_nodes + ledger.total.n_duplicated);
  EXPECT_NEAR(total_mass(body.mesh) / mass_before, 1, 1e-12);
  EXPECT_EQ(n_pieces(body.mesh), 2);
}

TEST(TetCutter, keeps_the_volume_of_a_body_with_flat_faces) {
  Body body(block());
  const Vec3 normal = Vec3(0.3, 1, 0.4).normalized();
  cut(body, plane_blade({0.5, 0.5, 0.5}, normal, 2), normal, 30);
  EXPECT_NEAR(total_volume(body.mesh), 1, 1e-12);  // rounding
}

// Of elements that the plane of the incision crosses; a ring more for each `n`.
std::vector<std::uint8_t> rings_around_incision(const Mesh& mesh, int n) {
  std::vector<std::uint8_t> is_in(mesh.element_type.size(), 0), is_corner(mesh.X.size(), 0);
  const auto off_plane = [&](std::int32_t i) {
    return across.dot(mesh.X[i] - Vec3(0.03, 0.022, 0));
  };
  const auto add = [&](const auto& belongs) {
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      if (belongs(e)) is_in[e] = 1;
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      for (const std::int32_t i : mesh.corners(e))
        if (is_in[e] != 0) is_corner[i] = 1;
  };
  add([&](std::int32_t e) {
    const auto [least, most] = std::ranges::minmax(mesh.corners(e), {}, off_plane);
    return off_plane(least) < 0 && off_plane(most) > 0;
  });
  for (int ring = 0; ring < n; ++ring)
    add([&](std::int32_t e) {
      return std::ranges::any_of(mesh.corners(e), [&](auto i) { return is_corner[i] != 0; });
    });
  return is_in;
}

TEST(TetCutter, leaves_elements_beyond_three_rings_as_they_were) {
  Body body(slab());
  const Mesh before = body.mesh;
  cut(body, incision(), across, 25);
  const auto three = rings_around_incision(before, 3), one = rings_around_incision(before, 1);
  int n_beyond = 0, n_beyond_first = 0;
  for (std::int32_t e = 0; e < before.n_elements(); ++e) {
    bool is_same = body.mesh.density_factor[e] == before.density_factor[e];
    for (std::size_t a = 0; a < 4; ++a) {
      const std::int32_t i = before.corners(e)[a];
      is_same = is_same && body.mesh.corners(e)[a] == i && body.mesh.X[i] == before.X[i];
    }
    EXPECT_TRUE(is_same || three[e] != 0) << e;
    n_beyond += three[e] == 0 ? 1 : 0;
    n_beyond_first += !is_same && one[e] == 0 ? 1 : 0;
  }
  EXPECT_GT(n_beyond, 500);
  EXPECT_GT(n_beyond_first, 0);  // else fewer rings would do
}

TEST(TetCutter, carries_an_affine_motion_over_exactly) {
  Body body(block());
  Mat3 F;
  F << 1.1, 0.2, 0, -0.1, 0.95, 0.1, 0.05, 0, 1.2;
  body.deform([&](const Vec3& X) { return F * X; });
  const Vec3 normal = Vec3(1, 0.2, -0.4).normalized();
  cut(body, plane_blade(F * Vec3(0.5, 0.5, 0.5), normal, 2), normal, 40);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  for (std::size_t i = 0; i < body.x.size(); ++i)  // rounding, over some ten edits
    EXPECT_NEAR((body.x[i] - F * body.mesh.X[i]).norm(), 0, 1e-13);
}

// Twice as many cells a side: four times as many nodes at a plane, of eight times as many.
TEST(TetCutter, moves_and_copies_nodes_in_proportion_to_the_area_that_it_cuts) {
  const Vec3 normal = Vec3(1, 0.5, 0.2).normalized();
  CutFigures figures[2];
  for (const int k : {0, 1}) {
    const int n = 6 * (k + 1);
    Body body(make_box({0, 0, 0}, {1, 1, 1}, {n, n, n}, BoxElements::tet4_kuhn));
    figures[k] = cut(body, plane_blade({0.5, 0.5, 0.5}, normal, 1), normal, 1).total;
  }
  const auto growth = [&](std::int32_t CutFigures::*n) {
    return double(figures[1].*n) / (figures[0].*n);
  };
  EXPECT_NEAR(growth(&CutFigures::n_opened_facets), 4, 1);  // in steps, as others lie next to it
  EXPECT_NEAR(growth(&CutFigures::n_duplicated), 4, 0.4);
  EXPECT_NEAR(growth(&CutFigures::n_moved), 4, 0.4);
}

TEST(TetCutter, cuts_a_body_into_four_with_two_crossing_strokes) {
  Body body(block());
  TetCutter cutter{CutTetOptions{}};
  const Vec3 centre(0.52, 0.47, 0.5), n1 = Vec3(1, 0.1, 0.3).normalized(), n2 = n1.unitOrthogonal();
  cut(body, plane_blade(centre, n1, 1.5), n1, 30, cutter);
  cut(body, plane_blade(centre, n2, 1.5), n2, 30, cutter);
  EXPECT_EQ(n_pieces(body.mesh), 4);
  EXPECT_EQ(fault(body), "");
}

TEST(TetCutter, follows_a_blade_that_turns) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, BoxElements::tet4_five));
  // On a circle of radius 1.2 around (0.5, -0.7), from left to right, as wide as the body.
  const auto blade = [](double t) {
    const double u = 0.4 * (2 * t - 1);  // tangent of half the angle: no libm needed
    const Vec3 radial(2 * u / (1 + u * u), (1 - u * u) / (1 + u * u), 0);
    std::vector<Vec3> edge;
    for (int k = 0; k <= 10; ++k) edge.push_back(Vec3(0.5, -0.7, -0.5 + 0.2 * k) + 1.2 * radial);
    return edge;
  };
  cut(body, blade, Vec3::UnitY(), 40);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_NEAR(total_volume(body.mesh), 1, 1e-12);  // rounding: the cut's two faces are the same
  EXPECT_EQ(fault(body), "");
}

TEST(TetCutter, changes_nothing_if_the_blade_misses_the_body) {
  Body body(block());
  const Ledger ledger =
      cut(body, straight_blade({2, 2, 2}, {3, 2, 2}, {0, 1, 0}), Vec3::UnitZ(), 5);
  EXPECT_EQ(ledger.n_edits, 0);
}

TEST(TetCutter, changes_nothing_when_the_same_cut_is_made_again) {
  Body body(block());
  TetCutter cutter{CutTetOptions{}};
  const Vec3 normal = Vec3(1, 0.5, 0.2).normalized();
  const Blade blade = plane_blade({0.5, 0.5, 0.5}, normal, 1.5);
  EXPECT_GT(cut(body, blade, normal, 30, cutter).total.n_duplicated, 0);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  const Mesh once = body.mesh;
  const Ledger again = cut(body, blade, normal, 30, cutter);
  EXPECT_EQ(again.total.n_duplicated, 0);
  EXPECT_EQ(again.total.n_moved, 0);
  EXPECT_EQ(body.mesh.X, once.X);
  EXPECT_EQ(body.mesh.corner_node, once.corner_node);
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(n_pieces(body.mesh), 2);
}

TEST(TetCutter, does_not_move_held_nodes) {
  Body body(block());
  for (std::size_t i = 0; i < body.x.size(); ++i) body.is_held[i] = body.mesh.X[i].z() == 0 ? 1 : 0;
  const std::vector<Vec3> before = body.mesh.X;
  const Vec3 normal = Vec3(1, 0.5, 0.2).normalized();
  cut(body, plane_blade({0.5, 0.5, 0.5}, normal, 1.5), normal, 30);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].z() > 0) continue;
    EXPECT_EQ(body.mesh.X[i], before[i]);
  }
  EXPECT_EQ(fault(body), "");
}

TEST(TetCutter, gives_the_same_bits_again) {
  std::vector<Vec3> first;
  for (int run = 0; run < 2; ++run) {
    Body body(slab());
    cut(body, incision(), across, 25);
    if (run == 0)
      first = body.mesh.X;
    else
      EXPECT_EQ(first, body.mesh.X);
  }
}

// A plane through the whole body, taken up in one band; the edit is made when the blade is out.
// `forget` changes what the stroke remembers in between.
CutFigures cut_through(Body& body, const std::function<void(CutStroke&)>& forget) {
  const Vec3 normal = Vec3(1, 0.5, 0.2).normalized();
  const Blade blade = plane_blade({0.52, 0.5, 0.5}, normal, 1.5);
  TetCutter cutter{CutTetOptions{.advance = 100}};
  CutFigures figures;
  KnownPositions positions(body.mesh, body.x);
  cutter.advance(body.mesh, positions, {body.is_held}, {blade(0), blade(1), normal}, false,
                 figures);
  CutStroke stroke = cutter.stroke();
  forget(stroke);
  cutter.set_stroke(stroke);
  Ledger ledger;
  const MeshEdit edit = cutter.advance(body.mesh, positions, {body.is_held},
                                       {blade(1), blade(1.1), normal}, true, figures);
  apply(edit, figures, body, ledger);
  return figures;
}

TEST(TetCutter, parts_elements_behind_the_blade_although_an_edge_slipped_past_it) {
  const Vec3 centre(0.5, 0.5, 0.5);
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {6, 6, 6}, BoxElements::tet4_kuhn));
  const CutFigures figures = cut_through(body, [&](CutStroke& stroke) {
    Vec3 slipped = Vec3::Zero();
    for (const CutHit& hit : stroke.hit)
      if ((hit.X - centre).norm() < (slipped - centre).norm()) slipped = hit.X;
    std::erase_if(stroke.hit, [&](const CutHit& hit) { return hit.X == slipped; });
  });
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(figures.n_refused, 0);
}

}  // namespace
}  // namespace trocar
