// Which cells become elements, and which meshes are refused.
#include <gtest/gtest.h>

#include "error_of.h"
#include "mesh/raw_mesh.h"

namespace trocar::test {
namespace {

using Corners = std::vector<std::int32_t>;

RawMesh raw_mesh(const std::vector<Vec3>& X) {
  RawMesh raw;
  raw.file = "f";
  raw.tag_word = "gmsh tag";
  raw.X = X;
  return raw;
}

// Unit tetrahedra one after the other along x, numbered from tag 800.
RawMesh tetrahedra(const std::vector<bool>& is_mirrored) {
  RawMesh raw = raw_mesh({});
  for (std::size_t e = 0; e < is_mirrored.size(); ++e) {
    const double x = 2.0 * static_cast<double>(e);
    for (const Vec3& X : {Vec3(x, 0, 0), Vec3(x + 1, 0, 0), Vec3(x, 1, 0), Vec3(x, 0, 1)})
      raw.X.push_back(X);
    const auto i = static_cast<std::int32_t>(4 * e);
    const Corners corners =
        is_mirrored[e] ? Corners{i, i + 1, i + 3, i + 2} : Corners{i, i + 1, i + 2, i + 3};
    add_cell(raw, CellKind::tetrahedron, corners, 800 + static_cast<std::int64_t>(e), 0);
  }
  return raw;
}

const std::vector<Vec3> cube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

TEST(MakeMesh, tetrahedra_that_are_all_mirrored_are_turned_round) {
  const Mesh mesh = make_mesh(tetrahedra({true, true}), 1);
  for (std::int32_t e = 0; e < 2; ++e) EXPECT_EQ(element_volume(mesh, e, mesh.X), 1.0 / 6);
}

TEST(MakeMesh, a_mirrored_hexahedron_is_turned_round) {
  RawMesh raw = raw_mesh(cube);
  add_cell(raw, CellKind::hexahedron, Corners{4, 5, 6, 7, 0, 1, 2, 3}, 1, 0);
  const Mesh mesh = make_mesh(raw, 1);
  EXPECT_EQ(element_volume(mesh, 0, mesh.X), 1);  // sums of integers: exact
  EXPECT_EQ(mesh.corner_node, (Corners{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(MakeMesh, a_mixture_of_both_orientations_is_refused) {
  EXPECT_EQ(error_of([] {
              make_mesh(tetrahedra({false, true, false}), 1);
            }),
            "f: element 1 (gmsh tag 801) is inverted: volume -0.1667 m^3 (1 of 3 elements are)");
}

TEST(MakeMesh, a_flat_element_is_refused) {
  RawMesh raw = tetrahedra({false, false});
  raw.X[7].z() = 1e-13;
  EXPECT_EQ(error_of([&] { make_mesh(raw, 1); }),
            "f: element 1 (gmsh tag 801) is flat: volume 1.667e-14 m^3 with edges up to 1.414 m");
}

TEST(MakeMesh, flatness_does_not_depend_on_the_unit) {
  for (const double scale : {1e-60, 1e-3, 1e60}) {
    const Mesh mesh = make_mesh(tetrahedra({false}), scale);
    EXPECT_GT(element_volume(mesh, 0, mesh.X), 0);
  }
}

TEST(MakeMesh, elements_beyond_the_range_of_double_are_refused) {
  EXPECT_NE(error_of([] { make_mesh(tetrahedra({false}), 1e150); }).find("is too large"),
            std::string::npos);
  EXPECT_NE(error_of([] { make_mesh(tetrahedra({false}), 1e-150); }).find("is flat"),
            std::string::npos);
}

TEST(MakeMesh, a_node_at_two_corners_is_refused) {
  RawMesh raw = raw_mesh(cube);
  add_cell(raw, CellKind::hexahedron, Corners{0, 1, 2, 3, 4, 5, 6, 6}, 31, 0);
  EXPECT_EQ(error_of([&] { make_mesh(raw, 1); }),
            "f: element 0 (gmsh tag 31) has one node at two corners");
}

TEST(MakeMesh, nodes_that_no_element_uses_are_dropped) {
  RawMesh raw = raw_mesh({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {0, 1, 0}, {0, 0, 1}});
  add_cell(raw, CellKind::tetrahedron, Corners{1, 2, 4, 5}, 1, 0);
  const Mesh mesh = make_mesh(raw, 1);
  EXPECT_EQ(mesh.n_nodes(), 4);
  EXPECT_EQ(mesh.corner_node, (Corners{0, 1, 2, 3}));
}

TEST(MakeMesh, triangles_in_a_plane_are_a_plane_mesh_at_height_zero) {
  RawMesh raw = raw_mesh({{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
  add_cell(raw, CellKind::triangle, Corners{0, 2, 1}, 1, 0);
  const Mesh mesh = make_mesh(raw, 1);
  EXPECT_EQ(mesh.dimension(), 2);
  EXPECT_EQ(mesh.X[2], Vec3(0, 1, 0));
  EXPECT_EQ(element_volume(mesh, 0, mesh.X), 0.5);  // listed clockwise, turned round
}

TEST(MakeMesh, a_quadrangle_in_a_plane_mesh_is_refused) {
  RawMesh raw = raw_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_cell(raw, CellKind::quadrangle, Corners{0, 1, 2, 3}, 4, 0);
  EXPECT_EQ(error_of([&] { make_mesh(raw, 1); }),
            "f: element 0 (gmsh tag 4) is a quadrangle: a plane mesh is made of triangles only");
}

TEST(MakeMesh, a_surface_in_space_is_refused) {
  RawMesh raw = raw_mesh(cube);
  add_cell(raw, CellKind::triangle, Corners{0, 1, 2}, 1, 0);
  add_cell(raw, CellKind::triangle, Corners{4, 5, 6}, 2, 0);
  EXPECT_EQ(error_of([&] { make_mesh(raw, 1); }),
            "f: this file holds only a surface (2 triangles): make a volume mesh of it "
            "(docs/howto.md says how), or use it as an instrument");
}

TEST(MakeMesh, a_fibre_without_direction_is_refused) {
  RawMesh raw = tetrahedra({false});
  raw.fibre = {{0, Vec3::Zero()}};
  EXPECT_EQ(error_of([&] { make_mesh(raw, 1); }),
            "f: element 0 (gmsh tag 800) has a fibre direction of length 0");
}

TEST(MakeSurface, a_quadrangle_is_two_triangles) {
  RawMesh raw = raw_mesh(cube);
  add_cell(raw, CellKind::quadrangle, Corners{0, 1, 2, 3}, 1, 0);
  const std::vector<std::array<std::int32_t, 3>> expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(make_surface(raw).triangle, expected);
}

// Dense and sparse tags take different ways, both are compared with a plain search.
TEST(TagIndex, finds_what_a_plain_search_finds) {
  const std::vector<std::vector<std::int64_t>> lists = {
      {}, {5}, {3, 1, 2}, {-4, 7, 0}, {INT64_MIN, INT64_MAX, 0}, {1000000, -1000000, 12, 11}};
  for (const std::vector<std::int64_t>& tags : lists) {
    const TagIndex index(tags);
    EXPECT_EQ(index.duplicate(), -1);
    for (const std::int64_t tag :
         {INT64_MIN, INT64_MAX, std::int64_t{0}, std::int64_t{1}, std::int64_t{3}, std::int64_t{-4},
          std::int64_t{7}, std::int64_t{5}, std::int64_t{11}, std::int64_t{1000000}}) {
      const auto found = std::find(tags.begin(), tags.end(), tag);
      EXPECT_EQ(index.find(tag), found == tags.end() ? -1 : found - tags.begin());
    }
  }
}

TEST(TagIndex, finds_the_second_of_two_equal_tags) {
  EXPECT_EQ(TagIndex(std::vector<std::int64_t>{4, 5, 6, 5}).duplicate(), 3);
  EXPECT_EQ(TagIndex(std::vector<std::int64_t>{4, INT64_MAX, 6, 4}).duplicate(), 3);
}

}  // namespace
}  // namespace trocar::test
