// Surfaces from STL and OBJ.
#include <gtest/gtest.h>

#include "mesh/mesh_file.h"
#include "mesh/mesh_file_formats.h"
#include "mesh_refusal.h"
#include "mesh_sample_files.h"
#include "test_files.h"

namespace trocar::test {
namespace {

TriangleMesh accepted(const std::string& name, const std::string& content) {
  const TestFolder folder;
  return read_triangle_mesh(folder.file(name, content), 1);
}

std::string refusal(const std::string& name, const std::string& content) {
  return refusal_by(read_triangle_mesh, name, content);
}

// The positions of the corners, triangle by triangle: what does not depend on vertex numbers.
std::vector<Vec3> corners(const TriangleMesh& mesh) {
  std::vector<Vec3> X;
  for (const auto& triangle : mesh.triangle)
    for (const std::int32_t i : triangle) X.push_back(mesh.X[i]);
  return X;
}

std::vector<Vec3> expected_corners() {
  std::vector<Vec3> X;
  for (const auto& face : tetrahedron_face)
    for (const int i : face) X.emplace_back(sample_X[i][0], sample_X[i][1], sample_X[i][2]);
  return X;
}

TEST(SurfaceFile, every_format_gives_the_same_tetrahedron) {
  for (const auto& [name, content] : {std::pair{"a.stl", stl_ascii()},
                                      {"a.stl", stl_binary()},
                                      {"a.stl", stl_binary("solid looks like text")},
                                      {"a.obj", obj()}}) {
    const TriangleMesh mesh = accepted(name, content);
    EXPECT_EQ(mesh.X.size(), 4U);
    EXPECT_EQ(corners(mesh), expected_corners());
  }
}

TEST(SurfaceFile, of_capitals_or_behind_a_mark_of_its_encoding_is_read) {
  const std::string mark = "\xEF\xBB\xBF";
  std::string capitals = stl_ascii();
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const auto& [name, content] :
       {std::pair{"a.stl", capitals}, {"a.stl", mark + stl_ascii()}, {"a.obj", mark + obj()}})
    EXPECT_EQ(corners(accepted(name, content)), expected_corners());
}

TEST(SurfaceFile, several_solids_make_one_surface) {
  EXPECT_EQ(accepted("a.stl", stl_ascii() + stl_ascii()).triangle.size(), 8U);
  EXPECT_EQ(accepted("a.stl", stl_ascii() + stl_ascii()).X.size(), 4U);
}

TEST(SurfaceFile, a_polygon_is_a_fan_of_triangles) {
  const TriangleMesh mesh =
      accepted("a.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5 # five\n");
  const std::vector<std::array<std::int32_t, 3>> expected = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(mesh.triangle, expected);
}

TEST(SurfaceFile, equal_positions_are_one_vertex_and_minus_zero_is_zero) {
  const TriangleMesh mesh = accepted(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 1 -0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 5 6 4\n");
  const std::vector<std::array<std::int32_t, 3>> expected = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_EQ(mesh.triangle, expected);
}

TEST(SurfaceFile, triangles_without_area_and_unused_vertices_are_dropped) {
  const TriangleMesh mesh =
      accepted("a.obj", "v 0 0 0\nv 5 5 5\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 3 5\nf 1 3 4\nf 3 3 4\n");
  EXPECT_EQ(mesh.X.size(), 3U);
  EXPECT_EQ(mesh.triangle.size(), 1U);
}

TEST(SurfaceFile, faces_that_do_not_fit_are_named) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(refusal("a.obj", vertices + "f 1 2 4\n"),
            "4: a face refers to vertex 4, but 3 vertices stand above it");
  EXPECT_EQ(refusal("a.obj", vertices + "f 1 2 0\n"),
            "4: a face refers to vertex 0, but 3 vertices stand above it");
  EXPECT_EQ(refusal("a.obj", vertices + "f 1 -4 2\n"),
            "4: a face refers to vertex -4, but 3 vertices stand above it");
  EXPECT_EQ(refusal("a.obj", vertices + "f 1 2\n"), "4: a face has 2 corners; 3 are the least");
  EXPECT_EQ(refusal("a.obj", vertices + "f 1 2 x\n"),
            "4: a corner of a face should be a vertex number as in 7, 7/1 or 7//3, not \"x\"");
  EXPECT_EQ(refusal("a.obj", vertices), " holds no triangle with an area");
}

TEST(SurfaceFile, a_large_polygon_that_comes_back_to_a_vertex_is_refused) {
  EXPECT_EQ(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3 2\n"),
            "5: a face of 5 corners has vertex 2 twice; split it into triangles");
}

TEST(SurfaceFile, an_stl_that_is_cut_off_is_refused) {
  const std::string text = stl_ascii(), binary = stl_binary();
  EXPECT_EQ(refusal("a.stl", text.substr(0, text.size() - 23)),
            "30: the file ends where endsolid should stand: it is cut off");
  EXPECT_EQ(
      refusal("a.stl", binary.substr(0, binary.size() - 1)),
      " byte 80: 4 triangles of a binary STL are announced, but the file goes on for only 199 "
      "bytes");
}

TEST(SurfaceFile, a_binary_stl_that_announces_too_few_triangles_is_refused) {
  std::string binary = stl_binary();
  binary[80] = 3;
  EXPECT_EQ(refusal("a.stl", binary),
            " byte 232: holds 50 bytes after the 3 triangles that it announces: its number of "
            "triangles is wrong");
  accepted("a.stl", stl_binary() + "tail");
}

TEST(SurfaceFile, a_binary_stl_whose_header_is_blank_and_which_is_cut_off_is_read_from_its_start) {
  const std::string binary = stl_binary();
  EXPECT_EQ(
      refusal("a.stl", std::string(80, ' ') + binary.substr(80, binary.size() - 81)),
      " byte 80: 4 triangles of a binary STL are announced, but the file goes on for only 199 "
      "bytes");
}

TEST(SurfaceFile, a_corner_that_is_not_finite_is_refused) {
  std::string content = stl_binary();
  content.replace(84 + 50 + 12, 4,
                  std::string("\0\0\xc0\x7f", 4));  // first x of the second triangle
  EXPECT_EQ(refusal("a.stl", content), " byte 154: triangle 1 has a corner not finite");
}

// Lines may begin with blanks, and "vn" are no vertices.
TEST(SurfaceFile, of_obj_has_its_vertices_counted_before_memory_is_taken_for_them) {
  std::string content = "vn 0 0 1\n \tv\t0 0 0\n";
  for (int k = 0; k < 999; ++k) content += "v 0 0 0\n";
  FileReader in("a.obj", content);
  const TriangleMesh mesh = read_obj(in);
  EXPECT_EQ(mesh.X.size(), 1000U);
  EXPECT_EQ(mesh.X.capacity(), 1000U);
}

}  // namespace
}  // namespace trocar::test
