#include "cutting/cut_boundary.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

int outer_planes(const Vec3& X) {
  int n = 0;
  for (int d = 0; d < 3; ++d) n += X[d] == 0 || X[d] == 1 ? 1 : 0;
  return n;
}

TEST(NodeBoundary, tells_inside_faces_edges_and_corners_of_a_box_apart) {
  const Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, BoxElements::tet4_five);
  const CutPatch patch = cutting_test::whole_patch(cutting_test::Body(mesh));
  const std::array<NodeFreedom, 4> expected{NodeFreedom::free, NodeFreedom::surface,
                                            NodeFreedom::edge, NodeFreedom::fixed};
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_EQ(node_boundary(patch, {}, mesh.cut_facets, i).freedom,
              expected[std::size_t(outer_planes(mesh.X[i]))])
        << mesh.X[i].transpose();
}

TEST(NodeBoundary, keeps_nodes_on_their_face_and_within_their_star) {
  const Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, BoxElements::tet4_kuhn);
  const CutPatch patch = cutting_test::whole_patch(cutting_test::Body(mesh));
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    if (outer_planes(mesh.X[i]) != 1 || mesh.X[i].z() != 1) continue;
    const NodeBoundary boundary = node_boundary(patch, {}, mesh.cut_facets, i);
    const Vec3 there = project_to_boundary(boundary, mesh.X[i] + Vec3(0.1, 0.05, 0.3));
    EXPECT_NEAR((there - mesh.X[i] - Vec3(0.1, 0.05, 0)).norm(), 0, 1e-15);  // rounding
    const Vec3 far = project_to_boundary(boundary, mesh.X[i] + Vec3(5, 5, 0));
    EXPECT_LE((far - mesh.X[i]).norm(), std::sqrt(2.0) / 3 + 1e-15);  // the star's farthest node
    EXPECT_NEAR((allowed_part(boundary, {1, 2, 3}) - Vec3(1, 2, 0)).norm(), 0, 1e-15);
  }
}

// Two regions that meet at x = 1/3.
TEST(NodeBoundary, holds_an_interface_as_it_holds_the_outer_surface) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, BoxElements::tet4_five);
  const auto is_between = [&](std::int32_t i) { return std::abs(mesh.X[i].x() - 1. / 3) < 1e-9; };
  cutting_test::add_region(mesh, [](const Vec3& X) { return X.x() > 1. / 3; });
  const CutPatch patch = cutting_test::whole_patch(cutting_test::Body(mesh));
  const std::array<NodeFreedom, 4> expected{NodeFreedom::free, NodeFreedom::surface,
                                            NodeFreedom::edge, NodeFreedom::fixed};
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    const NodeBoundary boundary = node_boundary(patch, {}, mesh.cut_facets, i);
    const int n_planes = outer_planes(mesh.X[i]) + (is_between(i) ? 1 : 0);
    EXPECT_EQ(boundary.freedom, expected[std::size_t(n_planes)]) << mesh.X[i].transpose();
    if (!is_between(i) || boundary.freedom == NodeFreedom::fixed) continue;
    const Vec3 there = project_to_boundary(boundary, mesh.X[i] + Vec3(0.1, 0.05, 0.07));
    EXPECT_NEAR(there.x(), mesh.X[i].x(), 1e-15);  // rounding
    EXPECT_NEAR(allowed_part(boundary, {1, 2, 3}).x(), 0, 1e-15);
  }
}

// The border of an area of the top runs along x = 1/3 from end to end.
TEST(NodeBoundary, holds_the_border_of_an_area_as_it_holds_a_sharp_edge) {
  const Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, BoxElements::tet4_kuhn);
  const auto is_on_border = [&](std::int32_t i) {
    return std::abs(mesh.X[i].x() - 1. / 3) < 1e-9 && mesh.X[i].z() == 1;
  };
  cutting_test::Body body(mesh);
  for (const BorderEdge& edge : mesh_edges(mesh))
    if (is_on_border(edge[0]) && is_on_border(edge[1])) body.border.push_back(edge);
  const CutPatch patch = cutting_test::whole_patch(body);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    if (!is_on_border(i)) continue;
    const NodeBoundary boundary = node_boundary(patch, {}, mesh.cut_facets, i);
    const bool is_end = outer_planes(mesh.X[i]) == 2;
    EXPECT_EQ(boundary.freedom, is_end ? NodeFreedom::fixed : NodeFreedom::edge);
    if (is_end) continue;
    const Vec3 there = project_to_boundary(boundary, mesh.X[i] + Vec3(0.1, 0.05, 0.3));
    EXPECT_NEAR((there - mesh.X[i] - Vec3(0, 0.05, 0)).norm(), 0, 1e-15);
  }
}

}  // namespace
}  // namespace trocar
