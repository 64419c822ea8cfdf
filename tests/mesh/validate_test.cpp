// Each way in which a mesh can be broken is found and named.
#include <gtest/gtest.h>

#include <limits>

#include "mesh/quality.h"
#include "mesh_fixtures.h"
#include "mesh_split.h"

using namespace trocar;

using Sentences = std::vector<std::string>;

static Mesh small_box() {
  return make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::tet4_five);
}

TEST(Validate, finds_nothing_in_generated_meshes) {
  for (const NamedMesh& named : all_meshes())
    EXPECT_EQ(validate(named.mesh), Sentences{}) << named.name;
}

TEST(Validate, names_an_inverted_element_with_volume_and_corners) {
  Mesh mesh = single_element(ElementType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  std::swap(mesh.corner_node[1], mesh.corner_node[2]);
  EXPECT_EQ(validate(mesh),
            Sentences{"element 0 (tet4) is inverted: volume -0.1667 m^3, corners 0 2 1 3"});
}

TEST(Validate, names_a_flat_triangle_with_its_area) {
  const Mesh mesh = single_element(ElementType::tri3, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_EQ(validate(mesh), Sentences{"element 0 (tri3) is flat: area 0 m^2, corners 0 1 2"});
}

TEST(Validate, names_a_corner_out_of_range_and_does_not_follow_it) {
  for (const std::int32_t corner : {-1, 8, std::numeric_limits<std::int32_t>::max()}) {
    Mesh mesh = small_box();
    mesh.corner_node[4 * 3 + 1] = corner;
    EXPECT_EQ(validate(mesh).front(), "element 3 (tet4) has corner " + std::to_string(corner) +
                                          ", but the nodes run from 0 to 7");
  }
}

TEST(Validate, names_a_repeated_corner) {
  Mesh mesh = small_box();
  mesh.corner_node[1] = mesh.corner_node[0];
  EXPECT_EQ(validate(mesh).front(), "element 0 (tet4) has node 0 at two corners: 0 0 2 4");
}

TEST(Validate, names_a_node_that_is_not_finite) {
  Mesh mesh = small_box();
  mesh.X[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(mesh), Sentences{"node 5 is not finite: (1, nan, 1)"});
}

TEST(Validate, names_a_node_without_elements) {
  Mesh mesh = small_box();
  mesh.X.emplace_back(2, 2, 2);
  EXPECT_EQ(validate(mesh), Sentences{"node 8 belongs to no element"});
}

TEST(Validate, names_a_facet_of_three_elements) {
  Mesh mesh = single_element(ElementType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  mesh.X.insert(mesh.X.end(), {{0, 0, 2}, {0, 0, 3}});
  add_element(mesh, ElementType::tet4, std::array{0, 1, 2, 4});
  add_element(mesh, ElementType::tet4, std::array{0, 1, 2, 5});
  EXPECT_EQ(validate(mesh), Sentences{"the facet of nodes 0 1 2 is shared by 3 elements: 0, 1, 2"});
}

TEST(Validate, names_elements_on_the_same_side_of_a_facet_with_its_place) {
  Mesh tets = single_element(ElementType::tet4, {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 1}});
  tets.X.emplace_back(0, 0, 2);
  add_element(tets, ElementType::tet4, std::array{1, 2, 0, 4});
  EXPECT_EQ(validate(tets), Sentences{"elements 0 and 1 overlap: both lie on one side of the facet "
                                      "of nodes 0 1 2, at (1, 1, 0) m"});
  Mesh triangles = single_element(ElementType::tri3, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  triangles.X.emplace_back(1, 2, 0);
  add_element(triangles, ElementType::tri3, std::array{0, 1, 3});
  EXPECT_EQ(validate(triangles), Sentences{"elements 0 and 1 overlap: both lie on one side of the "
                                           "facet of nodes 0 1, at (1, 0, 0) m"});
  Mesh hexes = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::hex8);
  const std::vector<std::int32_t> corner = hexes.corner_node;
  std::array<std::int32_t, 8> higher{};
  for (std::size_t a = 0; a < 8; ++a) {
    higher[a] = corner[a];
    if (a < 4) continue;
    higher[a] = hexes.n_nodes();
    const Vec3 above = hexes.X[corner[a]] + Vec3(0, 0, 1);
    hexes.X.push_back(above);
  }
  add_element(hexes, ElementType::hex8, higher);
  ASSERT_EQ(validate(hexes).size(), 1u);
  EXPECT_EQ(validate(hexes)[0].substr(0, 31), "elements 0 and 1 overlap: both ");
}

TEST(Validate, names_duplicate_elements_in_any_order_of_their_corners) {
  Mesh mesh = single_element(ElementType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  add_element(mesh, ElementType::tet4, std::array{1, 2, 0, 3});
  EXPECT_EQ(validate(mesh), Sentences{"elements 0 and 1 have the same corners: 0 1 2 3"});
  Mesh thrice = mesh;
  add_element(thrice, ElementType::tet4, std::array{0, 1, 2, 3});
  EXPECT_EQ(
      validate(thrice).front(),
      "elements 0 and 1 have the same corners: 0 1 2 3; so have 1 more: a file of MSH 2 names "
      "an element of two physical groups once for each");
  mesh.X.emplace_back(1, 1, 1);
  add_element(mesh, ElementType::tet4, std::array{1, 2, 3, 4});
  ASSERT_EQ(validate(mesh).size(), 2u);  // and the facet that all three share
  EXPECT_EQ(validate(mesh).front(), "elements 0 and 1 have the same corners: 0 1 2 3");
}

TEST(Validate, names_a_plane_mesh_that_is_not_plane) {
  Mesh mesh = make_rectangle(1, 1, 2, 2);
  mesh.X[3].z() = 0.25;
  EXPECT_EQ(validate(mesh), Sentences{"node 3 of a plane mesh has z = 0.25 m instead of 0"});
}

TEST(Validate, names_a_node_set_that_is_out_of_range_or_order) {
  Mesh mesh = small_box();
  mesh.node_sets = {{"held", {3, 2}}, {"lost", {4, 99}}};
  EXPECT_EQ(validate(mesh),
            (Sentences{"node set \"held\" is not strictly ascending",
                       "node set \"lost\" holds node 99, but the nodes run from 0 to 7"}));
}

TEST(Validate, names_a_region_and_a_density_factor_that_are_impossible) {
  Mesh mesh = small_box();
  mesh.element_region[1] = 3;
  mesh.density_factor[2] = 0;
  EXPECT_EQ(validate(mesh),
            (Sentences{"element 1 (tet4) has region 3, but there are 1",
                       "element 2 (tet4) has density factor 0, which must be positive"}));
}

TEST(Validate, names_arrays_of_the_wrong_length) {
  Mesh mesh = small_box();
  mesh.cut_facets.pop_back();
  EXPECT_EQ(validate(mesh), Sentences{"cut_facets has 4 entries instead of 5"});
  mesh = small_box();
  mesh.corner_node.pop_back();
  EXPECT_EQ(validate(mesh), Sentences{"corner_node has 19 entries instead of 20"});
}

TEST(Validate, names_corners_that_are_not_an_elements_own) {
  Mesh mesh = small_box();
  mesh.corner_offset[3] = 4;
  EXPECT_EQ(validate(mesh), Sentences{"corner_offset of element 3 is 4, where another element has "
                                      "corners"});
  for (const std::int32_t offset : {-1, 17, std::numeric_limits<std::int32_t>::max()}) {
    mesh.corner_offset[3] = offset;
    EXPECT_EQ(validate(mesh), Sentences{"corner_offset of element 3 is " + std::to_string(offset) +
                                        ", where there are none"});
  }
}

TEST(Validate, names_split_hexahedra_whose_tetrahedra_are_elsewhere) {
  const Mesh whole = make_box(Vec3::Zero(), Vec3::Ones(), {3, 1, 1}, BoxElements::hex8);
  Mesh mesh = whole;
  apply_edit({.splits = splits_of(whole, std::vector<std::int32_t>{0, 2})}, mesh);
  EXPECT_EQ(mesh.split_hexahedra, (std::vector<SplitHexahedron>{{0, 3}, {2, 8}}));
  EXPECT_TRUE(validate(mesh).empty());
  for (const auto& wrong : std::vector<std::vector<SplitHexahedron>>{
           {{0, 3}, {2, 9}}, {{1, 3}}, {{0, 3}, {2, 3}}, {{0, 1}}, {{-1, 3}}, {{9, 3}}}) {
    mesh.split_hexahedra = wrong;
    EXPECT_EQ(validate(mesh).size(), 1U);
  }
}

TEST(Validate, gives_no_more_sentences_than_asked_for) {
  Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {3, 3, 3}, BoxElements::tet4_kuhn);
  for (Vec3& X : mesh.X) X.x() *= -1;  // all elements inverted
  EXPECT_EQ(validate(mesh, 4).size(), 4U);
  EXPECT_EQ(validate(mesh).size(), 20U);
}
