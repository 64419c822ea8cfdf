// Edits of meshes and nodal fields.
#include "mesh/edit.h"

#include <gtest/gtest.h>

#include "mesh/node_corners.h"
#include "mesh/quality.h"
#include "mesh_fixtures.h"
#include "mesh_opened_box.h"

using namespace trocar;

// Barycentric coordinates of P in a tetrahedron.
static std::array<double, max_corners> weights(const Mesh& mesh, std::int32_t host, const Vec3& P) {
  const std::span<const std::int32_t> node = mesh.corners(host);
  Mat3 D;
  for (int k = 0; k < 3; ++k) D.col(k) = mesh.X[node[k + 1]] - mesh.X[node[0]];
  const Vec3 w = D.inverse() * (P - mesh.X[node[0]]);
  return {1 - w.sum(), w[0], w[1], w[2]};
}

static NodeMove move_to(const Mesh& mesh, std::int32_t node, std::int32_t host, const Vec3& X) {
  return {.node = node, .X = X, .host = host, .weight = weights(mesh, host, X)};
}

// With two nodes moved before.
struct MovedAndOpenedBox : OpenedBox {
  MovedAndOpenedBox() {
    const NodeElements around = node_elements(mesh);
    for (const std::int32_t i : {62, 63})  // interior neighbours, each in the other's star
      edit.moves.push_back(move_to(mesh, i, around.of(i)[5], mesh.X[i] + Vec3(0.02, -0.01, 0.03)));
  }
};

TEST(MeshEdit, leaves_a_sound_mesh_of_the_same_volume) {
  MovedAndOpenedBox box;
  const double V = total_volume(box.mesh);
  apply_edit(box.edit, box.mesh);
  EXPECT_EQ(validate(box.mesh), std::vector<std::string>{});
  EXPECT_NEAR(total_volume(box.mesh), V, 1e-14);  // 384 terms of 1/384
}

TEST(MeshEdit, tells_the_node_that_each_corner_has_afterwards) {
  MovedAndOpenedBox box;
  const Mesh before = box.mesh;
  apply_edit(box.edit, box.mesh);
  for (std::int32_t e = 0; e < before.n_elements(); ++e)
    for (std::int32_t c = 0; c < std::ssize(before.corners(e)); ++c)
      EXPECT_EQ(node_after(box.edit, before, e, c), box.mesh.corners(e)[c]);
}

TEST(MeshEdit, opens_a_slit_that_keeps_one_piece_and_a_spherical_surface) {
  MovedAndOpenedBox box;
  apply_edit(box.edit, box.mesh);
  const Surface surface = boundary_surface(box.mesh);
  EXPECT_TRUE(is_closed(surface.triangle));
  EXPECT_EQ(euler_characteristic(surface.triangle), 2);
}

TEST(MeshEdit, duplicates_lie_on_their_parents_and_join_their_node_sets) {
  MovedAndOpenedBox box;
  const std::int32_t n_nodes = box.mesh.n_nodes();
  apply_edit(box.edit, box.mesh);
  ASSERT_EQ(box.mesh.n_nodes(), n_nodes + static_cast<int>(box.edit.duplicate_parent.size()));
  for (std::size_t k = 0; k < box.edit.duplicate_parent.size(); ++k) {
    const std::int32_t parent = box.edit.duplicate_parent[k];
    const std::int32_t duplicate = n_nodes + static_cast<std::int32_t>(k);
    EXPECT_EQ(box.mesh.X[duplicate], box.mesh.X[parent]);
    for (const NodeSet& set : box.mesh.node_sets)
      EXPECT_EQ(std::count(set.node.begin(), set.node.end(), duplicate),
                std::count(set.node.begin(), set.node.end(), parent))
          << set.name;
  }
}

TEST(MeshEdit, keeps_an_affine_field_affine) {
  MovedAndOpenedBox box;
  const auto affine = [](const Vec3& X) {
    return Vec3(1 + 2 * X.x() - X.y(), X.z() * 3 - 0.5, X.x() + X.y() + X.z());
  };
  std::vector<double> field;
  for (const Vec3& X : box.mesh.X)
    field.insert(field.end(), {affine(X).x(), affine(X).y(), affine(X).z()});
  apply_edit(box.edit, box.mesh, 3, field);
  apply_edit(box.edit, box.mesh);
  ASSERT_EQ(field.size(), 3 * box.mesh.X.size());
  for (std::int32_t i = 0; i < box.mesh.n_nodes(); ++i)
    for (int k = 0; k < 3; ++k)  // four products of about 3
      EXPECT_NEAR(field[3 * i + k], affine(box.mesh.X[i])[k], 1e-14);
}

TEST(MeshEdit, moved_nodes_read_the_values_before_the_edit) {
  // Two nodes of one tetrahedron swap places: their values must be swapped, not copied one after
  // the other.
  Mesh mesh = single_element(ElementType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  MeshEdit edit;
  edit.moves = {{.node = 1, .X = mesh.X[2], .host = 0, .weight = {0, 0, 1, 0}},
                {.node = 2, .X = mesh.X[1], .host = 0, .weight = {0, 1, 0, 0}}};
  edit.duplicate_parent = {1};
  std::vector<double> field = {10, 11, 12, 13};
  apply_edit(edit, mesh, 1, field);
  EXPECT_EQ(field, (std::vector<double>{10, 12, 11, 13, 12}));
}

TEST(MeshEdit, sets_cut_facets_and_density_factors) {
  Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::tet4_five);
  MeshEdit edit;
  edit.cut_facets = {{.element = 2, .mask = 5}};
  edit.density = {{.element = 1, .factor = 1.25}};
  apply_edit(edit, mesh);
  EXPECT_EQ(mesh.cut_facets, (std::vector<std::uint8_t>{0, 0, 5, 0, 0}));
  EXPECT_EQ(mesh.density_factor, (std::vector<double>{1, 1.25, 1, 1, 1}));
}

TEST(EditedElements, are_those_whose_volume_corners_or_density_changed) {
  MovedAndOpenedBox box;
  box.edit.density = {{.element = 7, .factor = 2}};
  const std::vector<std::int32_t> edited =
      edited_elements(box.mesh, node_corners(box.mesh), box.edit);
  EXPECT_TRUE(std::is_sorted(edited.begin(), edited.end()));
  Mesh after = box.mesh;
  apply_edit(box.edit, after);
  for (std::int32_t e = 0; e < after.n_elements(); ++e) {
    bool is_changed = after.density_factor[e] != 1;
    for (int a = 0; a < 4; ++a) {
      const std::int32_t now = after.corners(e)[a], then = box.mesh.corners(e)[a];
      is_changed = is_changed || now != then || after.X[now] != box.mesh.X[then];
    }
    EXPECT_EQ(std::binary_search(edited.begin(), edited.end(), e), is_changed) << e;
  }
}
