// What every cut keeps, whatever its surface.
#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

// Centred on the origin, so that a mirror image has the same bits but for signs.
Mesh centred_block(double amount) {
  Mesh mesh = make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {8, 8, 8}, BoxElements::tet4_kuhn);
  jitter(mesh, amount, 5);
  return mesh;
}

Vec3 mirrored(const Vec3& X) {
  return {-X.x(), X.y(), X.z()};
}

Mesh mirrored(Mesh mesh) {
  for (Vec3& X : mesh.X) X = mirrored(X);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)  // else all would be inverted
    std::swap(mesh.corner_node[4 * e + 2], mesh.corner_node[4 * e + 3]);
  return mesh;
}

const Vec3 tilted = Vec3(1, 0.5, 0.2).normalized();

// Of the facets that cuts opened: areas of those that look along `normal` and of the others, and
// the sum of all area vectors.
struct CutArea {
  double along = 0, against = 0;
  Vec3 sum = Vec3::Zero();
};

CutArea cut_area(const Mesh& mesh, const Vec3& normal) {
  const Surface surface = boundary_surface(mesh);
  CutArea area;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    if (surface.is_cut[t] == 0) continue;
    const auto [a, b, c] = surface.triangle[t];
    const Vec3 n = 0.5 * (mesh.X[b] - mesh.X[a]).cross(mesh.X[c] - mesh.X[a]);
    area.sum += n;
    (n.dot(normal) > 0 ? area.along : area.against) += n.norm();
  }
  return area;
}

TEST(CutInvariants, a_through_cut_leaves_two_spheres) {
  Body body(centred_block(0.2));
  cut(body, plane_blade({0.02, 0.05, 0}, tilted, 1), tilted, 25);
  EXPECT_EQ(n_pieces(body.mesh), 2);
  EXPECT_EQ(euler_characteristic(body.mesh), 4);  // 2 each
  EXPECT_EQ(fault(body), "");
}

TEST(CutInvariants, a_cut_inside_the_body_is_a_closed_surface_of_its_own) {
  Body body(centred_block(0));
  const double r = 0.3;  // 2.4 cells: far from the outer surface
  const Vec3 u = tilted.unitOrthogonal(), way = tilted.cross(u);
  cut(body, straight_blade(-r * u - r * way, r * u - r * way, 2 * r * way), tilted, 12);
  EXPECT_EQ(n_pieces(body.mesh), 1);
  EXPECT_EQ(euler_characteristic(body.mesh), 4);  // the outer surface and the wound
  EXPECT_EQ(fault(body), "");
}

TEST(CutInvariants, both_faces_of_a_cut_have_the_same_area_and_opposite_normals) {
  for (const bool is_through : {true, false}) {
    Body body(centred_block(0.2));
    const Vec3 u = tilted.unitOrthogonal(), way = tilted.cross(u);
    const Blade blade = is_through ? plane_blade({0, 0, 0}, tilted, 1)
                                   : straight_blade(-0.3 * u - way, 0.3 * u - way, way);
    cut(body, blade, tilted, 25);
    const CutArea area = cut_area(body.mesh, tilted);
    EXPECT_GT(area.along, 0.1);
    // Rounding: the two faces have nodes at the same places. The sum alone would be zero of any two
    // faces with the same outline.
    EXPECT_NEAR(area.along / area.against, 1, 1e-13);
    EXPECT_LT(area.sum.norm(), 1e-13 * area.along);
  }
}

// Of the checks themselves: two tetrahedra that share a facet, the second one inverted.
TEST(CutInvariants, a_surface_that_is_not_oriented_is_a_fault) {
  Mesh mesh = single_element(ElementType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  mesh.X.emplace_back(1, 1, 1);
  add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{1, 2, 3, 4});
  EXPECT_EQ(boundary_fault(mesh), "");
  std::swap(mesh.corner_node[4], mesh.corner_node[5]);
  EXPECT_NE(boundary_fault(mesh), "");
}

TEST(CutInvariants, a_mirrored_body_is_cut_like_its_mirror_image) {
  Body body(centred_block(0.2)), image(mirrored(centred_block(0.2)));
  const Blade blade = plane_blade({0.02, 0.05, 0}, tilted, 1);
  const auto image_blade = [&](double t) {
    std::vector<Vec3> edge = blade(t);
    for (Vec3& p : edge) p = mirrored(p);
    return edge;
  };
  cut(body, blade, tilted, 25);
  cut(image, image_blade, mirrored(tilted), 25);
  ASSERT_EQ(image.mesh.n_nodes(), body.mesh.n_nodes());
  // Sums over corners run in another order; descent carries the rounding on.
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    EXPECT_LT((image.mesh.X[i] - mirrored(body.mesh.X[i])).norm(), 1e-9) << i;
}

TEST(CutInvariants, a_moved_and_turned_body_is_cut_alike) {
  // A quarter turn about z and a shift: exact but for the shift's rounding.
  const auto moved = [](const Vec3& X) { return Vec3(2 - X.y(), 1 + X.x(), X.z() - 3); };
  Body body(centred_block(0.2));
  Mesh other = body.mesh;
  for (Vec3& X : other.X) X = moved(X);
  Body turned(std::move(other));
  const Blade blade = plane_blade({0.02, 0.05, 0}, tilted, 1);
  const auto turned_blade = [&](double t) {
    std::vector<Vec3> edge = blade(t);
    for (Vec3& p : edge) p = moved(p);
    return edge;
  };
  cut(body, blade, tilted, 25);
  cut(turned, turned_blade, moved(tilted) - moved(Vec3::Zero()), 25);
  ASSERT_EQ(turned.mesh.n_nodes(), body.mesh.n_nodes());
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)  // descent carries the rounding on
    EXPECT_LT((turned.mesh.X[i] - moved(body.mesh.X[i])).norm(), 1e-9) << i;
}

TEST(CutInvariants, the_stable_step_keeps_its_floor_whatever_it_is) {
  for (const double floor : {0.35, 0.8, 0.95}) {
    Body body(centred_block(0));
    const double before = least_step_of(body.mesh);
    TetCutter cutter{CutTetOptions{.least_step_ratio = floor}};
    const Ledger ledger = cut(body, plane_blade({0.02, 0.05, 0}, tilted, 1), tilted, 25, cutter);
    EXPECT_GE(least_step_of(body.mesh), floor * before * (1 - 1e-12));
    EXPECT_EQ(n_pieces(body.mesh), 2);
    if (floor == 0.95) {
      EXPECT_GT(ledger.total.n_beside, 0);  // what the floor costs is told
    }
  }
}

// Of a slice 0.45 cells under a face, which a floor of 0.75 keeps off the blade. Where it was 0.75
// whatever the floor, lower ones changed nothing.
TEST(CutInvariants, lower_floors_let_grids_come_onto_the_blade) {
  const auto deviation = [](double floor) {
    Body body(centred_block(0));
    TetCutter cutter{CutTetOptions{.least_step_ratio = floor}};
    const double z = 0.5 - 0.45 / 8;
    const Ledger ledger =
        cut(body, plane_blade({0, 0, z}, Vec3::UnitZ(), 1), Vec3::UnitZ(), 25, cutter);
    EXPECT_EQ(n_pieces(body.mesh), 2) << floor;
    return 8 * ledger.deviation_sum / ledger.total.n_duplicated;
  };
  const double usual = deviation(0.75), lower = deviation(0.5);
  std::printf("%.3f and %.3f cells off the blade\n", usual, lower);
  EXPECT_GT(usual, 0.1);
  EXPECT_LT(lower, 0.01);
}

TEST(CutInvariants, whatever_stage_moves_the_nodes_the_body_stays_sound) {
  for (const CutStages stages :
       {CutStages::springs, CutStages::springs_then_barrier, CutStages::barrier}) {
    Body body(centred_block(0.2));
    const double before = least_step_of(body.mesh), mass_before = total_mass(body.mesh);
    TetCutter cutter{CutTetOptions{.stages = stages}};
    const Ledger ledger = cut(body, plane_blade({0.02, 0.05, 0}, tilted, 1), tilted, 25, cutter);
    EXPECT_EQ(fault(body), "");
    EXPECT_EQ(n_pieces(body.mesh), 2);
    EXPECT_NEAR(total_mass(body.mesh) / mass_before, 1, 1e-12);
    if (stages == CutStages::springs) {
      EXPECT_GT(ledger.total.n_pulled_back, 0);  // nothing in springs and particles sees volumes
    } else {
      EXPECT_EQ(ledger.total.n_inverted, 0);
      EXPECT_GE(least_step_of(body.mesh), CutTetOptions{}.least_step_ratio * before * (1 - 1e-12));
    }
  }
}

}  // namespace
}  // namespace trocar
