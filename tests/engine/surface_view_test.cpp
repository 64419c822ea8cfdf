#include "engine/surface_view.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/edit.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

struct BoxSurface {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1), {3, 4, 3}, BoxElements::hex8);
  Surface surface = boundary_surface(mesh);
};

// Displacement of a node that tells its number.
Vec3 displacement(std::int32_t node) {
  return {1e-3 * node, 2e-3 * node, -1e-3 * node};
}

std::vector<double> local_field(const Part& part) {
  std::vector<double> u;
  for (const std::int32_t global : part.node_global)
    for (int i = 0; i < 3; ++i) u.push_back(displacement(global)[i]);
  return u;
}

TEST(SurfaceView, on_one_rank_has_the_present_positions_of_all_surface_nodes) {
  BoxSurface c;
  const std::vector<std::int32_t> owner(c.mesh.X.size(), 0);
  const Part part = make_part(c.mesh, owner, 0);
  SurfaceView view = make_surface_view(c.surface, owner, part);
  Communicator alone;
  gather_surface(view, c.mesh.X, local_field(part), alone);
  EXPECT_EQ(view.node, c.surface.node);
  for (const std::int32_t i : c.surface.node) EXPECT_EQ(view.x[i], c.mesh.X[i] + displacement(i));
}

TEST(SurfaceView, lists_each_surface_node_once_by_owner_and_number) {
  BoxSurface c;
  const std::vector<std::int32_t> owner = partition_nodes(c.mesh, 3);
  const SurfaceView view = make_surface_view(c.surface, owner, make_part(c.mesh, owner, 1));
  for (std::size_t k = 1; k < view.node.size(); ++k)
    EXPECT_LT(std::pair(owner[view.node[k - 1]], view.node[k - 1]),
              std::pair(owner[view.node[k]], view.node[k]));
  std::vector<std::int32_t> sorted = view.node;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, c.surface.node);
}

// What the ranks send, one after the other, must be what every rank expects to receive.
TEST(SurfaceView, the_ranks_values_in_rank_order_meet_the_nodes_in_the_order_of_the_list) {
  BoxSurface c;
  const std::vector<std::int32_t> owner = partition_nodes(c.mesh, 3);
  std::vector<std::int32_t> sent;
  std::vector<std::int32_t> expected;
  for (int rank = 0; rank < 3; ++rank) {
    const Part part = make_part(c.mesh, owner, rank);
    const SurfaceView view = make_surface_view(c.surface, owner, part);
    for (const std::int32_t local : view.local) {
      EXPECT_LT(local, part.n_owned);
      sent.push_back(part.node_global[local]);
    }
    expected = view.node;
  }
  EXPECT_EQ(sent, expected);
}

TEST(SurfaceView, after_an_edit_is_that_of_the_edited_surface_and_keeps_where_the_others_are) {
  BoxSurface c;
  std::vector<std::int32_t> owner = partition_nodes(c.mesh, 3);
  const Part part = make_part(c.mesh, owner, 1);
  SurfaceView view = make_surface_view(c.surface, owner, part);
  view.x = c.mesh.X;
  const Vec3 there(1, 2, 3);
  view.x[c.surface.node[0]] = there;

  MeshEdit edit;
  const std::int32_t parent = c.surface.node[5], copy = c.mesh.n_nodes();
  edit.duplicate_parent = {parent};
  const std::span<const std::int32_t> corner = c.mesh.corners(0);
  const auto at = std::find(corner.begin(), corner.end(), parent) - corner.begin();
  ASSERT_LT(at, std::ssize(corner));
  edit.corners = {{.element = 0, .corner = static_cast<std::int32_t>(at), .node = copy}};
  apply_edit(edit, c.mesh);
  apply_edit_to_owners(edit, owner);
  const Surface surface = boundary_surface(c.mesh);
  const Part after = make_part(c.mesh, owner, 1);
  update_surface_view(surface, owner, after, view);
  const SurfaceView expected = make_surface_view(surface, owner, after);
  EXPECT_EQ(view.node, expected.node);
  EXPECT_EQ(view.local, expected.local);
  EXPECT_EQ(view.x.size(), c.mesh.X.size());
  EXPECT_EQ(view.x[c.surface.node[0]], there);
}

}  // namespace
}  // namespace trocar
