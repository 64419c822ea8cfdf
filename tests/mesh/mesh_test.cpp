// Volumes, masses and node sets.
#include "mesh/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "mesh_fixtures.h"

using namespace trocar;

// 2 x 2 x 2 Gauss points integrate the Jacobian of the trilinear map (degree 2 in each direction)
// exactly.
static double gauss_volume(const std::vector<Vec3>& X) {
  const double g = 1 / std::sqrt(3.0);
  double V = 0;
  for (int q = 0; q < 8; ++q) {
    const Vec3 xi((q & 1) != 0 ? g : -g, (q & 2) != 0 ? g : -g, (q & 4) != 0 ? g : -g);
    Mat3 J = Mat3::Zero();
    for (std::size_t a = 0; a < 8; ++a) {
      const Vec3 s = 2 * unit_cube_corners()[a] - Vec3::Ones();
      const Vec3 t = Vec3::Ones() + s.cwiseProduct(xi);
      const Vec3 dN(s.x() * t.y() * t.z() / 8, t.x() * s.y() * t.z() / 8,
                    t.x() * t.y() * s.z() / 8);
      J += X[a] * dN.transpose();
    }
    V += J.determinant();
  }
  return V;
}

TEST(ElementVolume, hexahedron_volume_is_the_gauss_integral_of_its_trilinear_map) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  for (int sample = 0; sample < 100; ++sample) {
    std::vector<Vec3> X = unit_cube_corners();
    for (Vec3& corner : X) corner += Vec3(offset(random), offset(random), offset(random));
    const Mesh mesh = single_element(ElementType::hex8, X);
    EXPECT_NEAR(element_volume(mesh, 0, mesh.X), gauss_volume(X), 1e-14);  // some 50 roundings of 1
  }
}

TEST(ElementVolume, tetrahedron_at_three_unit_edges_has_a_sixth) {
  const Mesh mesh = single_element(ElementType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_DOUBLE_EQ(element_volume(mesh, 0, mesh.X), 1.0 / 6);
}

TEST(ElementVolume, swapping_two_corners_changes_the_sign) {
  Mesh tet = single_element(ElementType::tet4, {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}});
  Mesh tri = single_element(ElementType::tri3, {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}});
  for (Mesh* mesh : {&tet, &tri}) {
    const double V = element_volume(*mesh, 0, mesh->X);
    std::swap(mesh->corner_node[0], mesh->corner_node[1]);
    EXPECT_GT(V, 0);
    EXPECT_DOUBLE_EQ(element_volume(*mesh, 0, mesh->X), -V);
  }
}

TEST(ElementVolume, is_taken_in_the_given_positions) {
  const Mesh mesh = single_element(ElementType::hex8, unit_cube_corners());
  std::vector<Vec3> x = mesh.X;
  for (Vec3& position : x) position *= 2;
  EXPECT_DOUBLE_EQ(element_volume(mesh, 0, x), 8);
}

TEST(LumpedMass, sums_to_density_times_volume) {
  const double density = 1060, thickness = 0.003;
  for (const NamedMesh& named : all_meshes()) {
    const std::vector<double> mass = lumped_mass(named.mesh, std::vector{density}, thickness);
    const double depth = named.mesh.dimension() == 2 ? thickness : 1;
    const double expected = density * total_volume(named.mesh) * depth;
    // A sum of some thousand positive terms is good to a thousand roundings.
    EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0), expected, 1e-13 * expected)
        << named.name;
  }
}

TEST(LumpedMass, is_spread_equally_on_the_corners_by_region_and_density_factor) {
  Mesh mesh;
  mesh.X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  add_element(mesh, ElementType::tet4, std::array{0, 1, 2, 3}, 0);
  add_element(mesh, ElementType::tet4, std::array{1, 2, 3, 4}, 1);
  mesh.region_name = {"soft", "dense"};
  mesh.density_factor = {1, 0.5};
  const double V0 = 1.0 / 6, V1 = 2.0 / 6;  // the second one: det of edges from 1 is 2
  const std::vector<double> mass = lumped_mass(mesh, std::vector{12.0, 60.0}, 1);
  EXPECT_DOUBLE_EQ(mass[0], 12 * V0 / 4);
  EXPECT_DOUBLE_EQ(mass[4], 60 * 0.5 * V1 / 4);
  EXPECT_DOUBLE_EQ(mass[2], mass[0] + mass[4]);
}

TEST(Mesh, of_triangles_only_has_two_dimensions) {
  EXPECT_EQ(make_rectangle(1, 1, 3, 3).dimension(), 2);
  EXPECT_EQ(make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::hex8).dimension(), 3);
}

TEST(Mesh, finds_node_sets_by_name) {
  const Mesh mesh = make_rectangle(1, 1, 3, 4);
  ASSERT_NE(find_node_set(mesh, "y-"), nullptr);
  EXPECT_EQ(find_node_set(mesh, "y-")->node, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(find_node_set(mesh, "z-"), nullptr);
}
