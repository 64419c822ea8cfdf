// A surface that an edit was applied to, against the surface of the edited mesh.
#include "mesh/surface_edit.h"

#include <gtest/gtest.h>

#include "base/sort_unique.h"
#include "mesh/node_corners.h"
#include "mesh_opened_box.h"

using namespace trocar;

// With the same nodes as the edit's own code finds them.
static std::vector<std::int32_t> edited_nodes(const OpenedBox& box, const Mesh& after) {
  const std::vector<std::int32_t> elements =
      edited_elements(box.mesh, node_corners(box.mesh), box.edit);
  std::vector<std::int32_t> nodes = nodes_of(box.mesh, elements);
  for (const std::int32_t i : nodes_of(after, elements)) nodes.push_back(i);
  sort_unique(nodes);
  return nodes;
}

TEST(SurfaceEdit, gives_the_surface_of_the_edited_mesh) {
  for (const BoxElements elements :
       {BoxElements::tet4_kuhn, BoxElements::tet4_five, BoxElements::hex8}) {
    OpenedBox box(elements);
    // Each opened facet is marked on both sides, as the cutter does: here all facets of edited
    // ones.
    for (const std::int32_t e : edited_elements(box.mesh, node_corners(box.mesh), box.edit))
      box.edit.cut_facets.push_back({.element = e, .mask = 15});
    Surface surface = boundary_surface(box.mesh);
    Mesh after = box.mesh;
    apply_edit(box.edit, after);
    const NodeCorners corners = node_corners(after);
    const std::vector<std::int32_t> nodes = edited_nodes(box, after);
    const std::vector<std::int32_t> touching = elements_around(corners, nodes);
    const SubMesh around =
        make_sub_mesh(after, elements_around(corners, nodes_of(after, touching)));
    update_surface(after, {nodes, touching, around}, surface);
    const Surface expected = boundary_surface(after);
    EXPECT_EQ(surface.triangle, expected.triangle);
    EXPECT_EQ(surface.element, expected.element);
    EXPECT_EQ(surface.is_cut, expected.is_cut);
    EXPECT_EQ(surface.is_quad_half, expected.is_quad_half);
    EXPECT_EQ(surface.node, expected.node);
    EXPECT_GT(expected.triangle.size(), boundary_surface(box.mesh).triangle.size());
  }
}

TEST(SurfaceEdit, takes_back_what_an_edit_opened) {
  OpenedBox box;
  const Surface closed = boundary_surface(box.mesh);
  Mesh mesh = box.mesh;
  apply_edit(box.edit, mesh);
  Surface surface = boundary_surface(mesh);
  const std::vector<std::int32_t> nodes = edited_nodes(box, mesh);
  for (const CornerChange& change : box.edit.corners)  // the duplicates are left without elements
    mesh.corner_node[mesh.corner_offset[change.element] + change.corner] =
        box.mesh.corners(change.element)[change.corner];
  const NodeCorners corners = node_corners(mesh);
  const std::vector<std::int32_t> touching = elements_around(corners, nodes);
  const SubMesh around = make_sub_mesh(mesh, elements_around(corners, nodes_of(mesh, touching)));
  update_surface(mesh, {nodes, touching, around}, surface);
  EXPECT_EQ(surface.triangle, closed.triangle);
  EXPECT_EQ(surface.element, closed.element);
  EXPECT_EQ(surface.node, closed.node);
}
