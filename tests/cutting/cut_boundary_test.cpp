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

}  // namespace
}  // namespace trocar
