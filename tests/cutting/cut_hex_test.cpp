// Cuts of hexahedra: which ones stay, what becomes of the others, and what no cut may change.
#include "cutting/cut_hex.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cutting/cut_hex_shape.h"
#include "cutting_tet.h"
#include "known_positions.h"
#include "mesh/hex_split.h"

namespace trocar {
namespace {

using namespace cutting_test;

Mesh hex_block(double amount, int n = 6) {
  Mesh mesh = make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {n, n, n}, BoxElements::hex8);
  if (amount > 0) jitter(mesh, amount, 3);
  return mesh;
}

int n_of(const Mesh& mesh, ElementType type) {
  return int(std::count(mesh.element_type.begin(), mesh.element_type.end(), type));
}

double bound_of(const Mesh& mesh, std::int32_t e) {
  const auto c = mesh.corners(e);
  if (c.size() == 4) return tet_step_bound(mesh, e);
  std::array<Vec3, 8> X;
  for (std::size_t a = 0; a < 8; ++a) X[a] = mesh.X[c[a]];
  return hex_step_bound(X);
}

double least_bound(const Mesh& mesh) {
  double least = 1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) least = std::min(least, bound_of(mesh, e));
  return least;
}

bool has_same_bits(const MeshEdit& a, const MeshEdit& b) {
  const auto same_move = [](const NodeMove& p, const NodeMove& q) {
    return p.node == q.node && p.X == q.X && p.host == q.host && p.weight == q.weight;
  };
  const auto same_corner = [](const CornerChange& p, const CornerChange& q) {
    return p.element == q.element && p.corner == q.corner && p.node == q.node;
  };
  const auto same_density = [](const DensityChange& p, const DensityChange& q) {
    return p.element == q.element && p.factor == q.factor;
  };
  const auto same_facets = [](const CutFacets& p, const CutFacets& q) {
    return p.element == q.element && p.mask == q.mask;
  };
  const auto same_split = [](const ElementSplit& p, const ElementSplit& q) {
    return p.element == q.element && p.corner == q.corner;
  };
  const auto equal = [](const auto& p, const auto& q, const auto& same) {
    return std::equal(p.begin(), p.end(), q.begin(), q.end(), same);
  };
  return equal(a.splits, b.splits, same_split) && equal(a.moves, b.moves, same_move) &&
         a.duplicate_parent == b.duplicate_parent && equal(a.corners, b.corners, same_corner) &&
         equal(a.cut_facets, b.cut_facets, same_facets) &&
         equal(a.density, b.density, same_density);
}

// Far from all layers of the grid: nodes alone can't follow.
const Vec3 off_grid = Vec3(1, 0.9, 0.7).normalized();

TEST(CutHex, a_cut_beside_a_layer_of_facets_displaces_nodes_and_converts_nothing) {
  Body body(hex_block(0));
  const Vec3 normal(0, 0, 1);  // a tenth of an edge beside the facets at z = 0
  const Ledger ledger = cut(body, plane_blade({0, 0, 0.1 / 6}, normal, 1), normal, 25);
  EXPECT_EQ(n_of(body.mesh, ElementType::hex8), 216);
  EXPECT_EQ(body.mesh.n_elements(), 216);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(euler_characteristic(body.mesh), 4);  // two spheres
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(ledger.total.n_duplicated, 49);  // 7 x 7 nodes of that layer
  for (std::int32_t i = 343; i < body.mesh.n_nodes(); ++i)
    EXPECT_NEAR(body.mesh.X[i].z(), 0.1 / 6, 1e-12);  // rounding of coordinates near 1
}

TEST(CutHex, a_cut_across_the_grid_converts_what_it_passes_through_and_no_more) {
  Body body(hex_block(0));
  cut(body, plane_blade({0.02, 0.05, 0}, off_grid, 1), off_grid, 25);
  const int n_hex = n_of(body.mesh, ElementType::hex8);
  const int n_tet = n_of(body.mesh, ElementType::tet4);
  EXPECT_EQ(n_hex + n_tet / 6, 216);
  EXPECT_GT(n_tet, 0);
  // Opened facets have their nodes within an edge of the plane, and a cell is one diagonal long.
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    if (body.mesh.element_type[e] != ElementType::tet4) continue;
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t i : body.mesh.corners(e)) centre += 0.25 * body.mesh.X[i];
    EXPECT_LT(std::abs(off_grid.dot(centre - Vec3(0.02, 0.05, 0))), 2 * std::sqrt(3.0) / 6);
  }
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(euler_characteristic(body.mesh), 4);
  EXPECT_EQ(fault(body), "");
}

TEST(CutHex, random_cuts_keep_the_body_sound_its_mass_and_the_floor_under_the_step) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int k = 0; k < 30; ++k) {
    Body body(hex_block(k % 2 == 0 ? 0 : 0.1));
    const double mass_before = total_mass(body.mesh), step = least_bound(body.mesh);
    Vec3 normal;
    do normal = {u(random), u(random), u(random)};
    while (normal.norm() > 1 || normal.norm() < 0.1);
    normal.normalize();
    const Vec3 centre = 0.2 * Vec3(u(random), u(random), u(random));
    cut(body, plane_blade(centre, normal, 1), normal, 25);
    EXPECT_EQ(n_pieces(body.mesh), 2) << k;
    EXPECT_EQ(fault(body), "") << k;
    EXPECT_NEAR(total_mass(body.mesh), mass_before, 1e-13) << k;  // 1300 terms of rounding
    // Tetrahedra keep 0.75 of theirs, which is 1/sqrt(2) of a cube's; that of a distorted cell may
    // be less of its own.
    const double floor = k % 2 == 0 ? CutTetOptions{}.least_step_ratio / std::sqrt(2.0) : 0.45;
    EXPECT_GE(least_bound(body.mesh), floor * (1 - 1e-12) * step) << k;
  }
}

TEST(CutHex, positions_in_an_affine_field_stay_affine) {
  Mat3 A;
  A << 1.1, 0.2, 0, -0.1, 0.9, 0.1, 0, 0.05, 1.2;
  const auto map = [&](const Vec3& X) { return Vec3(A * X + Vec3(1, 2, 3)); };
  Body body(hex_block(0.1));
  body.deform(map);
  const Vec3 normal = (A.inverse().transpose() * off_grid).normalized();
  cut(body, plane_blade(map({0.02, 0.05, 0}), normal, 2), normal, 40);
  EXPECT_GT(n_of(body.mesh, ElementType::tet4), 0);
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)  // edits carry rounding on
    EXPECT_LT((body.x[i] - map(body.mesh.X[i])).norm(), 1e-13);
}

// Returns the number of edits that split hexahedra.
int edits_with_other_cutters(Body& body, const Vec3& normal) {
  const Blade blade = plane_blade({0.02, 0.05, 0}, normal, 1);
  TetCutter cutter{CutTetOptions{}};
  Ledger ledger;
  int n_edits = 0;
  for (int k = 0; k < 25; ++k) {
    const BladeSweep sweep{blade(k / 25.0), blade((k + 1) / 25.0), normal};
    TetCutter other{CutTetOptions{}};
    other.set_stroke(cutter.stroke());
    CutFigures figures;
    KnownPositions positions(body.mesh, body.x);
    const MeshEdit again =
        other.advance(body.mesh, positions, {body.is_held}, sweep, k == 24, figures);
    const MeshEdit edit = advance(cutter, body, sweep, k == 24, ledger);
    EXPECT_TRUE(has_same_bits(edit, again)) << k;
    n_edits += edit.splits.empty() ? 0 : 1;
  }
  return n_edits;
}

TEST(CutHex, another_cutter_with_the_stroke_goes_on_to_the_same_bits) {
  Body body(hex_block(0.1));
  EXPECT_GT(edits_with_other_cutters(body, off_grid), 3);
}

// All of them have converted in three edits, and their tetrahedra are numbered as before.
TEST(CutHex, another_cutter_goes_on_in_a_body_that_has_no_hexahedron_left) {
  Body body(make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {1, 2, 2}, BoxElements::hex8));
  EXPECT_EQ(edits_with_other_cutters(body, off_grid), 1);
  EXPECT_EQ(edits_with_other_cutters(body, off_grid.cwiseProduct(Vec3(-1, 1, 1))), 2);
  EXPECT_EQ(body.mesh.n_elements(), 24);
  EXPECT_TRUE(was_hexahedral(body.mesh));
  EXPECT_FALSE(has_type(body.mesh, ElementType::hex8));
}

// Of tetrahedra and of hexahedra. Every second edit is made by the other one.
TEST(CutHex, a_cutter_that_follows_edits_makes_the_next_without_a_look_at_the_whole_mesh) {
  for (const BoxElements elements : {BoxElements::tet4_five, BoxElements::hex8}) {
    const Blade blade = plane_blade({0.02, 0.05, 0}, off_grid, 1);
    Body body(make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {6, 6, 6}, elements));
    Body alone = body;
    TetCutter cutters[] = {TetCutter(CutTetOptions{}), TetCutter(CutTetOptions{})},
              cutter_alone{CutTetOptions{}};
    for (TetCutter& cutter : cutters) cutter.prepare(body.mesh);
    Ledger ledger, ledger_alone;
    for (int k = 0; k < 25; ++k) {
      const BladeSweep sweep{blade(k / 25.0), blade((k + 1) / 25.0), off_grid};
      TetCutter &first = cutters[ledger.n_edits % 2], &second = cutters[1 - ledger.n_edits % 2];
      EXPECT_TRUE(first.is_prepared(body.mesh)) << k;
      CutFigures figures;
      KnownPositions positions(body.mesh, body.x);
      const CutterEdit edit =
          first.advance(body.mesh, positions, {body.is_held}, sweep, k == 24, figures);
      second.follow(body.mesh, edit);
      second.set_stroke(first.stroke());
      apply(edit, figures, body, ledger);
      EXPECT_TRUE(has_same_bits(edit, advance(cutter_alone, alone, sweep, k == 24, ledger_alone)));
      EXPECT_TRUE(second.is_prepared(body.mesh)) << k;
    }
    EXPECT_GT(ledger.n_edits, 3);
  }
}

TEST(CutHex, cuts_that_cross_leave_quarters) {
  Body body(hex_block(0));
  const Vec3 other = off_grid.unitOrthogonal();
  cut(body, plane_blade({0.02, 0.05, 0}, off_grid, 1), off_grid, 25);
  cut(body, plane_blade({0.02, 0.05, 0}, other, 1), other, 25);
  EXPECT_EQ(n_pieces(body.mesh), 4);
  EXPECT_EQ(fault(body), "");
}

TEST(CutHex, held_nodes_stay_where_they_are) {
  Body body(hex_block(0));
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    body.is_held[i] = body.mesh.X[i].z() < -0.49 ? 1 : 0;
  const std::vector<Vec3> X = body.mesh.X;
  const std::vector<std::uint8_t> held = body.is_held;
  cut(body, plane_blade({0.02, 0.05, 0}, off_grid, 1), off_grid, 25);
  for (std::size_t i = 0; i < X.size(); ++i)
    EXPECT_TRUE(held[i] == 0 || body.mesh.X[i] == X[i]) << i;
  EXPECT_EQ(fault(body), "");
}

// Least present over reference volume of the body's tetrahedra.
double least_volume_ratio(const Body& body) {
  double least = 1;
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e)
    if (body.mesh.element_type[e] == ElementType::tet4)
      least = std::min(
          least, element_volume(body.mesh, e, body.x) / element_volume(body.mesh, e, body.mesh.X));
  return least;
}

// Every second node of a layer to the one side, the others to the other: the middles of the cells
// stay as they are.
Vec3 zigzag(const Vec3& X, double amount) {
  const Vec3 cell = (6 * (X + Vec3::Constant(0.5))).array().round();
  return X + Vec3(int(cell.x() + cell.y()) % 2 == 0 ? amount : -amount, 0, 0) / 6;
}

TEST(CutHex, hexahedra_that_are_bent_stay_hexahedra_and_are_cut_once_they_are_straight) {
  // Opened facets have moved no node that lies in the zigzag when they are seen.
  const Vec3 normal = off_grid;
  const Blade blade = plane_blade({0.02, 0.05, 0}, normal, 1);
  for (const bool straightens : {true, false}) {
    Body body(hex_block(0));
    TetCutter cutter{CutTetOptions{}};
    cutter.start_stroke();
    Ledger ledger;
    std::vector<CutRefusal> refusals;
    const int n_steps = 25;
    for (int k = 0; k < n_steps; ++k) {
      if (ledger.n_edits == 0)
        body.deform(
            [&](const Vec3& X) { return zigzag(X, straightens && k + 1 == n_steps ? 0 : 0.6); });
      CutFigures figures;
      const BladeSweep sweep{blade(double(k) / n_steps), blade(double(k + 1) / n_steps), normal};
      KnownPositions positions(body.mesh, body.x);
      const MeshEdit edit =
          cutter.advance(body.mesh, positions, {body.is_held}, sweep, k + 1 == n_steps, figures);
      apply(edit, figures, body, ledger);
      refusals = figures.refusals;
      EXPECT_GT(least_volume_ratio(body), 0.02) << k;
    }
    EXPECT_EQ(fault(body), "");
    EXPECT_EQ(n_pieces(body.mesh), straightens ? 2 : 1);
    EXPECT_EQ(n_of(body.mesh, ElementType::tet4) > 0, straightens);
    EXPECT_EQ(std::ranges::count(refusals, CutRefusal::bent, &CutRefusal::reason) > 0,
              !straightens);
  }
}

// Of those that are not whole, the least step bound of the tetrahedra over the hexahedron's.
double least_part_of_step(const Mesh& mesh) {
  const std::vector<std::int32_t> whole = whole_hexahedra(mesh);
  double least = 1;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (std::binary_search(whole.begin(), whole.end(), e)) continue;
    for (const auto& node : hex_tet_nodes(mesh, e))
      least = std::min(least, step_bound(mesh.X, node) / bound_of(mesh, e));
  }
  return least;
}

TEST(CutHex, grids_bent_to_balls_and_cylinders_keep_a_part_of_their_step_as_tetrahedra) {
  const BoxElements kind = BoxElements::hex8;
  for (const int n : {6, 8, 10, 20}) {
    Mesh cylinder = make_cylinder(Vec3::Zero(), 0.05, 0.1, n, n, kind);
    EXPECT_LT(least_part_of_step(cylinder), 0.11);
    cylinder.hex_split_rank = hex_split_ranks(cylinder);
    EXPECT_TRUE(whole_hexahedra(cylinder).empty());
    EXPECT_GT(least_part_of_step(cylinder), 0.43);
    Mesh ball = make_ball(Vec3::Zero(), 0.05, n, kind);
    EXPECT_LT(least_part_of_step(ball), 0.05);
    ball.hex_split_rank = hex_split_ranks(ball);
    // At the eight corners of the grid.
    EXPECT_EQ(whole_hexahedra(ball).size(), n < 20 ? 0U : 8U);
    EXPECT_GT(least_part_of_step(ball), 0.18);
  }
}

TEST(CutHex, boxes_need_no_ranks) {
  EXPECT_TRUE(hex_split_ranks(hex_block(0)).empty());
  EXPECT_TRUE(
      hex_split_ranks(make_box(Vec3::Zero(), {8, 2, 1}, {4, 4, 4}, BoxElements::hex8)).empty());
  EXPECT_TRUE(hex_split_ranks(make_box(Vec3::Zero(), {1, 1, 1}, {4, 4, 4}, BoxElements::tet4_kuhn))
                  .empty());
}

TEST(CutHex, what_stays_whole_does_so_after_cuts) {
  Body body(make_ball(Vec3::Zero(), 0.5, 20, BoxElements::hex8));
  body.mesh.hex_split_rank = hex_split_ranks(body.mesh);
  const double step = least_bound(body.mesh);
  const auto whole = [&] {
    std::vector<std::vector<std::int32_t>> nodes;
    for (const std::int32_t e : whole_hexahedra(body.mesh))
      nodes.emplace_back(body.mesh.corners(e).begin(), body.mesh.corners(e).end());
    return nodes;
  };
  const auto before = whole();
  ASSERT_EQ(before.size(), 8U);
  cut(body, plane_blade({0.02, 0.05, 0}, off_grid, 1), off_grid, 25);
  EXPECT_GT(n_of(body.mesh, ElementType::tet4), 0);
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(whole(), before);
  EXPECT_GE(least_bound(body.mesh), 0.75 * 0.18 * step);
}

TEST(CutHex, the_bound_of_a_cube_is_root_two_times_that_of_its_tetrahedra) {
  // |dV/dx_a|^2 = 3/16 at each corner of the unit cube: 1 / sqrt(2 * 8 * 3/16) = 1/sqrt(3). Kuhn's
  // tetrahedron: 6 V = 1, (2 area)^2 = 1, 1, 2, 2: 1/sqrt(6).
  const Mesh cube = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::hex8);
  const Mesh tets = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::tet4_kuhn);
  EXPECT_NEAR(bound_of(cube, 0), 1 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(bound_of(tets, 0), 1 / std::sqrt(6.0), 1e-15);
}

TEST(CutHex, the_least_jacobian_of_a_tapered_cell_is_that_of_its_narrow_end) {
  // Width 1 - t (z + 1)/2 in x: J = (1/8) (1 - t (1 + zeta)/2), least at zeta = 1/sqrt(3).
  const double t = 0.8, g = 1 / std::numbers::sqrt3;
  std::array<Vec3, 8> X{Vec3(0, 0, 0), Vec3(1, 0, 0),     Vec3(1, 1, 0),     Vec3(0, 1, 0),
                        Vec3(0, 0, 1), Vec3(1 - t, 0, 1), Vec3(1 - t, 1, 1), Vec3(0, 1, 1)};
  EXPECT_NEAR(least_gauss_ratio(X), (1 - t * (1 + g) / 2) / (1 - t / 2), 1e-14);
}

TEST(CutHex, a_hexahedron_beside_tetrahedra_with_the_other_diagonal_stays_whole) {
  // Five tetrahedra in the unit cube: on x = 1 their diagonal is that through the lowest node,
  // (1, 0, 0); on x = 0 it joins (0, 1, 0) and (0, 0, 1), while (0, 0, 0) has the lowest number.
  for (const bool is_right : {true, false}) {
    Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::tet4_five);
    mesh.node_sets.clear();
    const double x = is_right ? 2 : -1;
    std::vector<std::int32_t> near, far;
    for (const Vec3& X : {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 1, 1), Vec3(0, 0, 1)}) {
      const Vec3 wanted = X + Vec3(is_right ? 1 : 0, 0, 0);
      near.push_back(
          std::int32_t(std::find(mesh.X.begin(), mesh.X.end(), wanted) - mesh.X.begin()));
      far.push_back(mesh.n_nodes());
      mesh.X.push_back(X + Vec3(x, 0, 0));
    }
    const auto &left = is_right ? near : far, &right = is_right ? far : near;
    add_element(mesh, ElementType::hex8,
                std::vector<std::int32_t>{left[0], right[0], right[1], left[1], left[3], right[3],
                                          right[2], left[2]});
    ASSERT_EQ(validate(mesh), std::vector<std::string>{});
    ASSERT_EQ(n_pieces(mesh), 1);
    const std::vector<std::int32_t> expected =
        is_right ? std::vector<std::int32_t>{} : std::vector<std::int32_t>{5};
    EXPECT_EQ(whole_hexahedra(mesh), expected);
  }
}

}  // namespace
}  // namespace trocar
