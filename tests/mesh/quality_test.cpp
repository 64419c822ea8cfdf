// Shape quality and figures of whole meshes.
#include "mesh/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh_fixtures.h"

using namespace trocar;

static Mesh ideal_element(ElementType type) {
  if (type == ElementType::hex8) return single_element(type, unit_cube_corners());
  std::vector<Vec3> X = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  if (type == ElementType::tet4) X.emplace_back(0.5, std::sqrt(1.0 / 12), std::sqrt(2.0 / 3));
  return single_element(type, X);
}

TEST(ElementQuality, is_one_for_the_ideal_shape_of_any_size) {
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::hex8})
    for (const double scale : {1e-6, 1.0, 123.0}) {
      Mesh mesh = ideal_element(type);
      for (Vec3& X : mesh.X) X *= scale;
      EXPECT_NEAR(element_quality(mesh, 0, mesh.X), 1, 1e-14) << element_type_name(type);
    }
}

TEST(ElementQuality, of_any_other_shape_is_less_than_one) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> offset(-0.2, 0.2);
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::hex8})
    for (int sample = 0; sample < 100; ++sample) {
      Mesh mesh = ideal_element(type);
      for (Vec3& X : mesh.X)
        X += Vec3(offset(random), offset(random), type == ElementType::tri3 ? 0 : offset(random));
      EXPECT_LT(element_quality(mesh, 0, mesh.X), 1) << element_type_name(type);
    }
}

TEST(ElementQuality, is_negative_if_inverted_and_zero_if_flat) {
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::hex8}) {
    Mesh mesh = ideal_element(type);
    for (Vec3& X : mesh.X) X.y() *= -1;
    EXPECT_NEAR(element_quality(mesh, 0, mesh.X), -1, 1e-14) << element_type_name(type);
    for (Vec3& X : mesh.X) X.y() = 0;
    EXPECT_EQ(element_quality(mesh, 0, mesh.X), 0) << element_type_name(type);
  }
}

TEST(ElementQuality, of_a_tetrahedron_is_the_mean_ratio_with_libm_s_cube_root) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int sample = 0; sample < 200; ++sample) {
    Mesh mesh = ideal_element(ElementType::tet4);
    const double size = std::ldexp(1.0, sample % 61 - 30);  // through all exponents modulo 3
    for (Vec3& X : mesh.X)
      X = size * Vec3(coordinate(random), coordinate(random), coordinate(random));
    double sum = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) sum += (mesh.X[a] - mesh.X[b]).squaredNorm();
    const double root = std::cbrt(3 * element_volume(mesh, 0, mesh.X));
    const double expected = std::copysign(12 * root * root / sum, root);
    EXPECT_NEAR(element_quality(mesh, 0, mesh.X), expected, 1e-14);
  }
}

TEST(LeastAltitude, of_the_regular_tetrahedron_is_the_root_of_two_thirds) {
  const Mesh mesh = ideal_element(ElementType::tet4);
  EXPECT_NEAR(least_altitude(mesh, 0, mesh.X), std::sqrt(2.0 / 3), 1e-15);
}

TEST(LeastAltitude, of_a_right_triangle_stands_on_the_hypotenuse) {
  const Mesh mesh = single_element(ElementType::tri3, {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}});
  EXPECT_NEAR(least_altitude(mesh, 0, mesh.X), 12.0 / 5, 1e-15);
}

TEST(LeastAltitude, of_a_brick_is_its_shortest_edge) {
  const Mesh mesh = make_box(Vec3::Zero(), {3, 0.5, 2}, {1, 1, 1}, BoxElements::hex8);
  EXPECT_NEAR(least_altitude(mesh, 0, mesh.X), 0.5, 1e-15);
}

TEST(MeshStatistics, of_a_box_of_cubes_are_known) {
  const Mesh mesh = make_box({-1, 0, 0}, {1, 3, 1}, {2, 3, 1}, BoxElements::hex8);
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.n_elements_by_type, (std::array<std::int32_t, 3>{0, 0, 6}));
  EXPECT_EQ(s.n_nodes, 3 * 4 * 2);
  EXPECT_EQ(s.n_surface_triangles, 2 * 2 * (2 * 3 + 3 * 1 + 1 * 2));
  EXPECT_EQ(s.n_pieces, 1);
  EXPECT_NEAR(s.volume, 6, 1e-14);
  EXPECT_EQ(s.box.low, Vec3(-1, 0, 0));
  EXPECT_EQ(s.box.high, Vec3(1, 3, 1));
  for (const double edge : {s.edge_min, s.edge_mean, s.edge_max}) EXPECT_NEAR(edge, 1, 1e-14);
  for (const double q : {s.quality_min, s.quality_mean}) EXPECT_NEAR(q, 1, 1e-14);
}

TEST(MeshStatistics, name_the_worst_element) {
  Mesh mesh = make_rectangle(1, 1, 6, 6);
  mesh.X[14] += Vec3(0.05, 0.02, 0);
  const MeshStatistics s = mesh_statistics(mesh);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    EXPECT_GE(element_quality(mesh, e, mesh.X), s.quality_min);
  EXPECT_EQ(element_quality(mesh, s.worst_element, mesh.X), s.quality_min);
}

TEST(MeshStatistics, are_found_of_elements_that_share_a_facet_by_threes) {
  Mesh mesh;
  mesh.X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  for (const int top : {3, 4, 5}) add_element(mesh, ElementType::tet4, std::array{0, 1, 2, top});
  EXPECT_EQ(mesh_statistics(mesh).n_pieces, 1);
  EXPECT_FALSE(validate(mesh).empty());
}
