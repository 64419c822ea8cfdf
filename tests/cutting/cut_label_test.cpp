// Elements around one edge, and which of them hold the two sides of a cut together.
#include "cutting/cut_label.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr int n_in_turn = 8;  // tetrahedra in a full turn around the edge

// The first `n_tets` of a turn around the z axis; the swept surface is the plane x = 0, and the
// blade crossed none of them.
CutSurroundings turn_around_edge(int n_tets) {
  Mesh mesh;
  mesh.X = {{0, 0, 0}, {0, 0, 1}};
  for (int k = 0; k < std::min(n_tets + 1, n_in_turn); ++k) {
    const double angle = 2 * std::numbers::pi * k / n_in_turn;
    mesh.X.emplace_back(std::cos(angle), std::sin(angle), 0.5);
  }
  for (int k = 0; k < n_tets; ++k) {
    const std::array<std::int32_t, 4> corner{0, 2 + k, 2 + (k + 1) % n_in_turn, 1};
    add_element(mesh, ElementType::tet4, corner);
  }
  const Body body(std::move(mesh));
  CutSurroundings around;
  around.h = 1;
  around.patch = whole_patch(body);
  const std::size_t n_nodes = around.patch.node.size();
  around.points.offset.resize(n_nodes + 1);
  std::iota(around.points.offset.begin(), around.points.offset.end(), 0);
  around.points.point.assign(n_nodes, {.X = Vec3::Zero(), .N = Vec3::UnitX()});
  around.boundary.resize(n_nodes);
  for (const Vec3& X : around.patch.X) {
    around.distance.push_back(X.x());
    around.surface_cost.push_back(X.x() * X.x());
  }
  return around;
}

CutLabels labels_of(const std::vector<std::int8_t>& side) {
  CutLabels labels;
  labels.side = side;
  for (const std::int8_t s : side)
    labels.kind.push_back(s == 0 ? CutKind::uncut : CutKind::separated);
  labels.is_passed.assign(side.size(), 1);
  return labels;
}

TEST(PartBridges, gives_sides_to_all_that_holds_both_together_around_an_edge) {
  const CutSurroundings around = turn_around_edge(n_in_turn);
  CutLabels labels = labels_of({1, 0, 0, 0, -1, 0, 0, 0});
  EXPECT_TRUE(part_bridges(around, {}, labels));
  const std::vector<std::int8_t> expected{1, 1, -1, -1, -1, -1, 1, 1};  // of x
  EXPECT_EQ(labels.side, expected);
}

// The minimum cut gave element 1 to the only side that it knew of there.
TEST(PartBridges, lets_the_minimum_cut_decide_again_once_it_knows_both_sides) {
  const CutSurroundings around = turn_around_edge(n_in_turn);
  CutLabels labels = labels_of({0, -1, -1, -1, -1, -1, 1, 1});
  CutStroke stroke;
  for (const std::int32_t e : {2, 3, 4, 5, 6, 7}) stroke.side.push_back({e, labels.side[e]});
  EXPECT_TRUE(part_bridges(around, stroke, labels));
  const std::vector<std::int8_t> expected{1, 1, -1, -1, -1, -1, 1, 1};  // of x
  EXPECT_EQ(labels.side, expected);
}

TEST(PartBridges, leaves_alone_what_holds_to_one_side_only) {
  const CutSurroundings around = turn_around_edge(n_in_turn / 2);  // the edge is an outer one
  const std::vector<std::int8_t> side{0, 1, -1, 0};
  CutLabels labels = labels_of(side);
  EXPECT_FALSE(part_bridges(around, {}, labels));
  EXPECT_EQ(labels.side, side);
}

}  // namespace
}  // namespace trocar
