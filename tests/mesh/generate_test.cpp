// Counts, volumes and shapes of generated meshes.
#include "mesh/generate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "mesh/quality.h"
#include "mesh_fixtures.h"

using namespace trocar;

TEST(MakeBox, has_the_volume_of_the_box) {
  const Vec3 low(-0.1, 0.2, 0), high(0.2, 0.4, 0.1);
  for (const BoxElements elements :
       {BoxElements::hex8, BoxElements::tet4_kuhn, BoxElements::tet4_five}) {
    const Mesh mesh = make_box(low, high, {3, 4, 5}, elements);
    const double V = (high - low).prod();
    EXPECT_NEAR(total_volume(mesh), V, 1e-13 * V);  // some hundred terms
  }
}

TEST(MakeBox, has_one_six_or_five_elements_a_cell) {
  const std::array<int, 3> n = {2, 3, 4};
  const auto count = [&](BoxElements elements) {
    return make_box(Vec3::Zero(), Vec3::Ones(), n, elements).n_elements();
  };
  EXPECT_EQ(count(BoxElements::hex8), 24);
  EXPECT_EQ(count(BoxElements::tet4_kuhn), 6 * 24);
  EXPECT_EQ(count(BoxElements::tet4_five), 5 * 24);
}

TEST(MakeBox, ends_exactly_at_its_corners_and_names_its_sides) {
  const Vec3 low(-0.1, 0.2, 0.7), high(0.2, 0.4, 0.9);
  const Mesh mesh = make_box(low, high, {7, 6, 3}, BoxElements::hex8);
  EXPECT_EQ(mesh.node_sets.size(), 6U);
  for (int direction = 0; direction < 3; ++direction)
    for (const bool is_high : {false, true}) {
      const std::string name = std::string(1, "xyz"[direction]) + (is_high ? "+" : "-");
      const double side = (is_high ? high : low)[direction];
      std::vector<std::int32_t> expected;
      for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
        if (mesh.X[i][direction] == side) expected.push_back(i);
      EXPECT_FALSE(expected.empty());
      EXPECT_EQ(find_node_set(mesh, name)->node, expected) << name;
    }
}

TEST(MakeBox, refuses_no_cells_too_many_and_no_volume) {
  const Vec3 low = Vec3::Zero(), high = Vec3::Ones();
  EXPECT_THROW(make_box(low, high, {1, 0, 1}, BoxElements::hex8), InputError);
  EXPECT_THROW(make_box(low, high, {100000, 100000, 100000}, BoxElements::hex8), InputError);
  EXPECT_THROW(make_box(high, low, {1, 1, 1}, BoxElements::hex8), InputError);
}

// Distance of the surface of the mesh from the centre or axis.
template <class Distance>
static void expect_on_surface(const Mesh& mesh, const char* set, double radius, Distance distance) {
  ASSERT_NE(find_node_set(mesh, set), nullptr);
  ASSERT_FALSE(find_node_set(mesh, set)->node.empty());
  for (const std::int32_t i : find_node_set(mesh, set)->node)
    EXPECT_NEAR(distance(mesh.X[i]), radius, 4e-16) << set;  // a rounding of 0.3 in each coordinate
}

TEST(MakeBall, has_all_surface_nodes_and_no_others_on_the_sphere) {
  const Vec3 centre(0.1, -0.2, 0.3);
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const Mesh mesh = make_ball(centre, 0.05, 6, elements);
    expect_on_surface(mesh, "surface", 0.05, [&](const Vec3& X) { return (X - centre).norm(); });
    EXPECT_EQ(find_node_set(mesh, "surface")->node, boundary_surface(mesh).node);
  }
}

TEST(MakeBall, approaches_the_volume_of_the_ball_quadratically) {
  const auto defect = [](int n) {
    const Mesh mesh = make_ball(Vec3::Zero(), 1, n, BoxElements::tet4_kuhn);
    return 4 * std::numbers::pi / 3 - total_volume(mesh);
  };
  EXPECT_GT(defect(16), 0);                     // inscribed
  EXPECT_NEAR(defect(8) / defect(16), 4, 0.3);  // chords are off by h^2/8R; the next order is h^4
}

TEST(MakeCylinder, has_flat_ends_and_a_round_side) {
  const Vec3 base(0.1, -0.2, 0.3);
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const Mesh mesh = make_cylinder(base, 0.05, 0.2, 6, 3, elements);
    expect_on_surface(mesh, "side", 0.05,
                      [&](const Vec3& X) { return (X - base).head<2>().norm(); });
    expect_on_surface(mesh, "z-", 0, [&](const Vec3& X) { return X.z() - base.z(); });
    expect_on_surface(mesh, "z+", 0.2, [&](const Vec3& X) { return X.z() - base.z(); });
    std::set<std::int32_t> named;
    for (const NodeSet& set : mesh.node_sets) named.insert(set.node.begin(), set.node.end());
    EXPECT_EQ(boundary_surface(mesh).node, std::vector<std::int32_t>(named.begin(), named.end()));
  }
}

TEST(MakeCylinder, approaches_the_volume_of_the_cylinder_quadratically) {
  const auto defect = [](int n) {
    const Mesh mesh = make_cylinder(Vec3::Zero(), 1, 2, n, 2, BoxElements::hex8);
    return 2 * std::numbers::pi - total_volume(mesh);
  };
  EXPECT_GT(defect(16), 0);
  EXPECT_NEAR(defect(8) / defect(16), 4, 0.3);
}

TEST(RoundMeshes, of_kuhn_tetrahedra_keep_a_quality_of_0_6_for_any_n) {
  for (const int n : {2, 3, 4, 5, 8, 13, 20}) {
    EXPECT_GT(mesh_statistics(make_ball(Vec3::Zero(), 1, n, BoxElements::tet4_kuhn)).quality_min,
              0.6)
        << n;
    EXPECT_GT(mesh_statistics(make_cylinder(Vec3::Zero(), 1, 2, n, n, BoxElements::tet4_kuhn))
                  .quality_min,
              0.6)
        << n;
  }
}

TEST(RoundMeshes, have_no_thin_element_for_any_n) {
  for (const int n : {2, 3, 5, 8, 16})
    for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
      const Mesh mesh = make_ball(Vec3::Zero(), 1, n, elements);
      double least = 1;
      for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
        least = std::min(least, least_altitude(mesh, e, mesh.X));
      EXPECT_GT(least, 0.3 * 2 / n)
          << n;  // of the edge 2 R / n, so the stable step falls like 1 / n
    }
}

TEST(RoundMeshes, are_exactly_symmetric) {
  // Mirrored cells: every node has its mirror images among the nodes, to the last bit.
  const Mesh mesh = make_ball(Vec3::Zero(), 1, 6, BoxElements::tet4_kuhn);
  std::set<std::array<double, 3>> nodes;
  for (const Vec3& X : mesh.X) nodes.insert({X.x(), X.y(), X.z()});
  for (const Vec3& X : mesh.X) {
    EXPECT_TRUE(nodes.contains({-X.x(), X.y(), X.z()}));
    EXPECT_TRUE(nodes.contains({X.y(), X.x(), X.z()}));
    EXPECT_TRUE(nodes.contains({X.x(), X.z(), X.y()}));
  }
}

TEST(RoundMeshes, refuse_what_would_be_flat) {
  EXPECT_THROW(make_ball(Vec3::Zero(), 1, 8, BoxElements::tet4_five), InputError);
  EXPECT_THROW(make_ball(Vec3::Zero(), 1, 1, BoxElements::hex8), InputError);
  EXPECT_THROW(make_ball(Vec3::Zero(), 0, 4, BoxElements::hex8), InputError);
  EXPECT_THROW(make_cylinder(Vec3::Zero(), 1, 0, 4, 4, BoxElements::hex8), InputError);
}

struct PlaneFigures {
  int n_nodes, n_elements;
  double area, edge_min, edge_max;  // [m^2], [m]
};
static void expect_figures(const Mesh& mesh, const PlaneFigures& expected) {
  EXPECT_EQ(mesh.n_nodes(), expected.n_nodes);
  EXPECT_EQ(mesh.n_elements(), expected.n_elements);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    ASSERT_NEAR(element_volume(mesh, e, mesh.X), expected.area, 1e-13 * expected.area);
  const MeshStatistics statistics = mesh_statistics(mesh);
  EXPECT_NEAR(statistics.edge_min, expected.edge_min, 1e-15);
  EXPECT_NEAR(statistics.edge_max, expected.edge_max, 1e-15);
}

// Table 1 of Serby, Harders and Szekely 2001, initial meshes 1 to 4.
TEST(PlaneMeshes, configurations_1_and_2_have_the_paper_s_counts_and_sizes) {
  const auto expected = [](int nx, int ny, int n_nodes, int n_elements) {
    const double a = 0.070 / (nx - 1), b = 0.040 / (ny - 1);
    return PlaneFigures{n_nodes, n_elements, a * b / 2, b, std::sqrt(a * a + b * b)};
  };
  expect_figures(make_rectangle(0.070, 0.040, 10, 8), expected(10, 8, 80, 126));
  expect_figures(make_rectangle(0.070, 0.040, 20, 16), expected(20, 16, 320, 570));
  EXPECT_NEAR(expected(10, 8, 0, 0).area, 22.2222e-6, 1e-10);  // as printed, mm^2
}

TEST(PlaneMeshes, configurations_3_and_4_have_the_paper_s_counts_and_sizes) {
  const auto expected = [](int n, int n_nodes, int n_elements) {
    const double side = 0.070 / (n - 1);
    return PlaneFigures{n_nodes, n_elements, std::sqrt(3.0) / 4 * side * side, side, side};
  };
  expect_figures(make_triangular_rectangle(0.070, 10, 8), expected(10, 76, 119));
  expect_figures(make_triangular_rectangle(0.070, 20, 16), expected(20, 312, 555));
  EXPECT_NEAR(expected(10, 0, 0).area, 26.1946e-6, 1e-10);
  EXPECT_NEAR(expected(10, 0, 0).edge_min, 7.778e-3, 1e-6);
}

TEST(PlaneMeshes, diagonals_of_the_rectangle_rise) {
  const Mesh mesh = make_rectangle(0.070, 0.040, 10, 8);
  int n_diagonals = 0;
  for (const auto& [i, j] : mesh_edges(mesh)) {
    const Vec3 d = mesh.X[j] - mesh.X[i];
    if (d.x() == 0 || d.y() == 0) continue;
    ++n_diagonals;
    EXPECT_GT(d.x() * d.y(), 0);
  }
  EXPECT_EQ(n_diagonals, 9 * 7);
}

TEST(PlaneMeshes, of_alternating_rows_begin_with_a_long_one_at_the_origin) {
  const Mesh mesh = make_triangular_rectangle(0.070, 10, 8);
  EXPECT_EQ(mesh.X[0], Vec3(0, 0, 0));
  EXPECT_EQ(find_node_set(mesh, "y-")->node.size(), 10U);
  EXPECT_EQ(find_node_set(mesh, "y+")->node.size(), 9U);
  EXPECT_EQ(find_node_set(mesh, "x-")->node.size(), 8U);
  EXPECT_NEAR(mesh_statistics(mesh).box.high.y(), 47.151e-3, 1e-6);
}

TEST(PlaneMeshes, refuse_what_has_no_area) {
  EXPECT_THROW(make_rectangle(1, 1, 1, 5), InputError);
  EXPECT_THROW(make_rectangle(0, 1, 5, 5), InputError);
  EXPECT_THROW(make_triangular_rectangle(1, 2, 5), InputError);
}

TEST(Jitter, moves_interior_nodes_alone_and_by_no_more_than_the_amount) {
  for (const NamedMesh& named : all_meshes()) {
    Mesh mesh = named.mesh;
    jitter(mesh, 0.15, 5);
    const double longest = mesh_statistics(named.mesh).edge_max;
    const bool is_plane = mesh.dimension() == 2;
    const std::vector<std::int32_t> surface = boundary_surface(mesh).node;
    int n_moved = 0;
    for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
      const double distance = (mesh.X[i] - named.mesh.X[i]).norm();
      EXPECT_LE(distance, 0.15 * longest) << named.name;
      n_moved += distance > 0 ? 1 : 0;
      const bool is_outside = !is_plane && std::binary_search(surface.begin(), surface.end(), i);
      EXPECT_FALSE(is_outside && distance > 0) << named.name;
      EXPECT_FALSE(is_plane && mesh.X[i].z() != 0) << named.name;
    }
    EXPECT_GT(n_moved, 0) << named.name;
  }
}

TEST(Jitter, never_inverts_even_if_asked_for_too_much) {
  for (const NamedMesh& named : all_meshes()) {
    Mesh mesh = named.mesh;
    jitter(mesh, 2, 11);
    EXPECT_GT(mesh_statistics(mesh).quality_min, 0) << named.name;
    EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << named.name;
  }
}

TEST(Jitter, keeps_the_volume_and_depends_on_the_seed_alone) {
  const Mesh regular = make_box(Vec3::Zero(), Vec3::Ones(), {4, 4, 4}, BoxElements::tet4_kuhn);
  Mesh first = regular, second = regular, other = regular;
  jitter(first, 0.2, 1);
  jitter(second, 0.2, 1);
  jitter(other, 0.2, 2);
  EXPECT_NEAR(total_volume(first), 1, 1e-14);
  EXPECT_EQ(first.X, second.X);
  EXPECT_NE(first.X, other.X);
}
