// The order of nodes and elements in a file is no part of the body.
#include <gtest/gtest.h>

#include <bit>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

// New numbers, and the old ones in the new order.
struct Order {
  std::vector<std::int32_t> number, old;
};

Order random_order(std::int32_t n, std::mt19937& random) {
  Order order{std::vector<std::int32_t>(std::size_t(n)), std::vector<std::int32_t>(std::size_t(n))};
  std::iota(order.old.begin(), order.old.end(), 0);
  std::ranges::shuffle(order.old, random);
  for (std::int32_t k = 0; k < n; ++k) order.number[order.old[k]] = k;
  return order;
}

// Of tetrahedra; corners keep their places.
Mesh reordered(const Mesh& mesh, const Order& nodes, const Order& elements) {
  Mesh result = mesh;
  result.node_sets.clear();
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) result.X[nodes.number[i]] = mesh.X[i];
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (std::size_t a = 0; a < 4; ++a)
      result.corner_node[std::size_t(4 * elements.number[e]) + a] =
          nodes.number[mesh.corners(e)[a]];
  return result;
}

// How two meshes of the same elements differ after the same cuts.
struct Difference {
  int n_facets = 0;          // opened in one of them
  std::vector<double> node;  // between the same corners at opened facets, over h
};

void add_difference(const Mesh& mesh, const Mesh& other, const Order& elements, double h,
                    Difference& sum) {
  std::vector<double> way(mesh.X.size(), -1);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::int32_t k = elements.number[e];
    sum.n_facets += std::popcount(unsigned(mesh.cut_facets[e] ^ other.cut_facets[k]));
    for (int f = 0; f < 4; ++f) {
      if ((mesh.cut_facets[e] >> f & 1) == 0) continue;
      for (const int a : facet_corners(ElementType::tet4, f)) {
        if (a < 0) continue;
        const std::int32_t i = mesh.corners(e)[a];
        way[i] = (other.X[other.corners(k)[a]] - mesh.X[i]).norm() / h;
      }
    }
  }
  std::ranges::copy_if(way, std::back_inserter(sum.node), [](double d) { return d >= 0; });
}

// Descent goes from node to node in their order, and stops at the floor under the step where it
// comes to it.
TEST(CutOrder, of_nodes_and_elements_changes_no_topology_and_where_nodes_lie_by_little) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  Difference sum;
  for (int k = 0; k < 20; ++k) {
    SCOPED_TRACE(k);
    Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {6, 6, 6},
                         k % 2 == 0 ? BoxElements::tet4_kuhn : BoxElements::tet4_five);
    if (k % 4 >= 2) jitter(mesh, 0.2, unsigned(k));
    const Order nodes = random_order(mesh.n_nodes(), random),
                elements = random_order(mesh.n_elements(), random);
    const double floor = CutTetOptions{}.least_step_ratio * least_step_of(mesh);
    Body body(mesh), other(reordered(mesh, nodes, elements));
    const Vec3 normal = Vec3(u(random), u(random), u(random)).normalized();
    const Vec3 centre = Vec3::Constant(0.5) + 0.1 * Vec3(u(random), u(random), u(random));
    const Blade blade = plane_blade(centre, normal, 1.5);
    cut(body, blade, normal, 40);
    cut(other, blade, normal, 40);
    EXPECT_EQ(n_pieces(other.mesh), 2);
    EXPECT_EQ(fault(other), "");
    EXPECT_NEAR(total_volume(other.mesh), 1, 1e-12);  // rounding, as below
    EXPECT_GE(least_step_of(other.mesh), floor * (1 - 1e-12));
    EXPECT_EQ(other.mesh.n_nodes(), body.mesh.n_nodes());
    add_difference(body.mesh, other.mesh, elements, mean_edge_length(mesh), sum);
  }
  EXPECT_EQ(sum.n_facets, 0);
  std::ranges::sort(sum.node);
  const std::size_t n = sum.node.size();
  std::printf("%zu nodes: %.4f h elsewhere in the median, 95 %% by %.3f h, at most %.3f h\n", n,
              sum.node[n / 2], sum.node[n * 95 / 100], sum.node[n - 1]);
  EXPECT_LT(sum.node[n / 2], 0.01);
  EXPECT_LT(sum.node[n * 95 / 100], 0.15);
  EXPECT_LT(sum.node[n - 1], 0.35);
}

}  // namespace
}  // namespace trocar
