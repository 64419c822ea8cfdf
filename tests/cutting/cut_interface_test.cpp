// Cuts beside, along and across what they must leave in place: interfaces between regions and
// borders of areas of the outer surface.
#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr double cell_edge = 0.125;
constexpr double interface_height = 0.5;

Mesh layered_block(BoxElements elements) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, elements);
  add_region(mesh, [](const Vec3& X) { return X.z() > interface_height; });
  return mesh;
}

// Of planar interfaces: the volumes change by rounding alone.
void expect_same_regions(const Mesh& before, const Mesh& after) {
  const std::vector<double> V0 = region_volumes(before), V = region_volumes(after);
  for (std::size_t r = 0; r < V.size(); ++r) EXPECT_NEAR(V[r] / V0[r], 1, 1e-12) << r;
}

void cut_layers_and_check(BoxElements elements, const Vec3& centre, const Vec3& normal) {
  const Mesh before = layered_block(elements);
  Body body(before);
  const Ledger ledger = cut(body, plane_blade(centre, normal, 1), normal, 20);
  expect_same_regions(before, body.mesh);
  EXPECT_EQ(n_pieces(body.mesh), 2) << centre.transpose() << ", " << normal.transpose();
  EXPECT_EQ(ledger.total.n_refused, 0);
  EXPECT_EQ(fault(body), "");
}

TEST(CutInterface, stays_where_it_is_when_a_plane_passes_beside_it) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8})
    for (const double distance : {-0.9, -0.5, -0.35, -0.12, 0.05, 0.2, 0.36, 0.6})
      cut_layers_and_check(elements, {0.5, 0.5, interface_height + distance * cell_edge},
                           Vec3::UnitZ());
}

// It is opened: the next nodes that may move are so far that they come less near to the blade.
TEST(CutInterface, is_opened_where_nothing_comes_nearer_to_the_blade) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8})
    for (const double distance : {-0.3, -0.2, -0.12, 0.05, 0.15, 0.25, 0.3}) {
      Body body(layered_block(elements));
      const Vec3 centre{0.5, 0.5, interface_height + distance * cell_edge};
      const Ledger ledger = cut(body, plane_blade(centre, Vec3::UnitZ(), 1), Vec3::UnitZ(), 20);
      EXPECT_EQ(n_pieces(body.mesh), 2);
      EXPECT_LE(ledger.total.largest_deviation, (std::abs(distance) + 1e-9) * cell_edge)
          << distance;
    }
}

TEST(CutInterface, stays_where_it_is_when_planes_cross_it) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8})
    for (int k = 0; k < 8; ++k) {
      const Vec3 centre = Vec3::Constant(0.5) + 0.1 * Vec3(u(random), u(random), u(random));
      cut_layers_and_check(elements, centre,
                           Vec3(u(random), u(random), 1.5 * u(random)).normalized());
    }
}

TEST(CutInterface, stays_where_it_is_when_a_cut_ends_inside_the_body) {
  for (const double z : {0.42, 0.47, 0.53, 0.6}) {
    const Mesh before = layered_block(BoxElements::tet4_kuhn);
    Body body(before);
    const Ledger ledger =
        cut(body, straight_blade({0.3, -0.2, z}, {0.7, -0.2, z + 0.02}, {0, 0.7, 0}),
            Vec3(-0.05, 0, 1).normalized(), 12);
    EXPECT_GT(ledger.total.n_opened_facets, 8) << z;
    expect_same_regions(before, body.mesh);
    EXPECT_EQ(fault(body), "");
  }
}

// Of the faces of the top whose nodes are or were in x <= 0.5.
double left_area(const Mesh& mesh, const std::vector<std::uint8_t>& is_left) {
  const Surface surface = boundary_surface(mesh);
  double area = 0;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const auto is_in = [&](std::int32_t i) { return is_left[mesh.uncut_node(i)] != 0; };
    const auto& [a, b, c] = surface.triangle[t];
    if (surface.is_cut[t] == 0 && is_in(a) && is_in(b) && is_in(c))
      area += 0.5 * (mesh.X[b] - mesh.X[a]).cross(mesh.X[c] - mesh.X[a]).norm();
  }
  return area;
}

TEST(CutBorder, of_an_area_stays_where_it_is_when_a_plane_passes_beside_it) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8})
    for (const double distance : {-0.6, -0.3, 0.3, 0.42}) {
      Body body(make_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, elements));
      std::vector<std::uint8_t> is_left;
      for (const Vec3& X : body.mesh.X) is_left.push_back(X.z() == 1 && X.x() <= 0.5 ? 1 : 0);
      const auto is_on_border = [&](std::int32_t i) {
        return is_left[i] != 0 && body.mesh.X[i].x() == 0.5;
      };
      for (const BorderEdge& edge : mesh_edges(body.mesh))
        if (is_on_border(edge[0]) && is_on_border(edge[1])) body.border.push_back(edge);
      const double x = 0.5 + distance * cell_edge;
      cut(body, straight_blade({x, -0.2, 0.4}, {x, -0.2, 1.2}, {0, 1.4, 0}), Vec3::UnitX(), 20);
      EXPECT_NEAR(left_area(body.mesh, is_left), 0.5, 1e-12) << distance;
      EXPECT_EQ(fault(body), "");
    }
}

}  // namespace
}  // namespace trocar
