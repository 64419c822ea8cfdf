#include "mesh/connected_nodes.h"

#include <gtest/gtest.h>

#include <numeric>

#include "mesh/generate.h"
#include "mesh_joined.h"

namespace trocar {
namespace {

TEST(ConnectedNodes, of_all_elements_of_a_box_are_one_group) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {3, 2, 2}, BoxElements::tet4_five);
  std::vector<std::int32_t> all(static_cast<std::size_t>(mesh.n_elements()));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(connected_nodes(mesh, all), std::vector<std::int32_t>(mesh.X.size(), 0));
}

TEST(ConnectedNodes, without_elements_stand_alone) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {2, 1, 1}, BoxElements::hex8);
  std::vector<std::int32_t> themselves(mesh.X.size());
  std::iota(themselves.begin(), themselves.end(), 0);
  EXPECT_EQ(connected_nodes(mesh, {}), themselves);
}

// Three triangles: two share node 4, the third has no node with them.
TEST(ConnectedNodes, carry_the_lowest_number_of_their_group) {
  Mesh mesh;
  mesh.X.assign(9, Vec3::Zero());
  add_element(mesh, ElementType::tri3, std::vector<std::int32_t>{7, 4, 2});
  add_element(mesh, ElementType::tri3, std::vector<std::int32_t>{0, 8, 3});
  add_element(mesh, ElementType::tri3, std::vector<std::int32_t>{4, 1, 6});
  EXPECT_EQ(connected_nodes(mesh, std::vector<std::int32_t>{0, 1, 2}),
            (std::vector<std::int32_t>{0, 1, 1, 0, 1, 5, 1, 1, 0}));
  EXPECT_EQ(connected_nodes(mesh, std::vector<std::int32_t>{0}),
            (std::vector<std::int32_t>{0, 1, 2, 3, 2, 5, 6, 2, 8}));
}

std::int32_t n_unjoined(const Mesh& mesh, double tolerance) {
  return count_unjoined(mesh, connected_nodes(mesh), tolerance);
}

// Two boxes face to face, one of them shifted by rounding; a third stands apart.
TEST(UnjoinedNodes, are_those_of_two_pieces_at_the_same_place) {
  const auto box = [](double x) {
    return make_box(Vec3(x, 0, 0), Vec3(x + 1, 1, 1), {3, 2, 2}, BoxElements::tet4_kuhn);
  };
  EXPECT_EQ(n_unjoined(box(0), 1e-6), 0);
  const Mesh side_by_side = joined(box(0), box(1 + 1e-12));
  EXPECT_EQ(n_unjoined(side_by_side, 1e-6), 2 * 9);
  EXPECT_EQ(n_unjoined(side_by_side, 1e-15), 0);
  EXPECT_EQ(n_unjoined(joined(side_by_side, box(2.5)), 1e-6), 2 * 9);
}

// The two lips of a slit that ends in the body.
TEST(UnjoinedNodes, are_none_within_a_piece) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {2, 2, 1}, BoxElements::hex8);
  const std::int32_t copy = mesh.n_nodes();  // of the middle of an edge at x = 0, for one element
  const std::int32_t split = mesh.corners(0)[3];
  mesh.X.push_back(mesh.X[split]);
  mesh.corner_node[3] = copy;
  EXPECT_EQ(n_unjoined(mesh, 1e-6), 0);
}

}  // namespace
}  // namespace trocar
