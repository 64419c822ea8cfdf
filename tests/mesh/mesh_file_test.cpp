// One small mesh in every format, and which format a file has.
#include "mesh/mesh_file.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "mesh_equal.h"
#include "mesh_sample_files.h"
#include "test_files.h"

namespace trocar::test {
namespace {

// Format 1.0 has no names: groups are called by their tags.
Mesh expected_mesh(const SampleFile& sample) {
  if (!sample.has_groups) return sample_mesh_without_groups();
  Mesh mesh = sample_mesh();
  if (!sample.has_names) {
    mesh.region_name = {"volume-2", "volume-5"};
    mesh.node_sets[0].name = "surface-3";
  }
  return mesh;
}

TEST(MeshFile, every_format_gives_the_same_mesh) {
  const TestFolder folder;
  for (const SampleFile& sample : sample_files()) {
    SCOPED_TRACE(sample.name);
    expect_equal(read_mesh(folder.file(sample.name, sample.content), 1), expected_mesh(sample));
  }
}

TEST(MeshFile, content_decides_before_the_ending) {
  const TestFolder folder;
  for (const SampleFile& sample : sample_files()) {
    SCOPED_TRACE(sample.name);
    expect_equal(read_mesh(folder.file("mesh.dat", sample.content), 1), expected_mesh(sample));
  }
}

TEST(MeshFile, carriage_returns_before_line_ends_change_nothing) {
  const TestFolder folder;
  for (const std::string& content :
       {gmsh_1(), gmsh_2_ascii(), gmsh_4_ascii(), vtk_4_ascii(), vtk_5_ascii(), vtu_ascii()}) {
    std::string with_returns;
    for (const char c : content) with_returns += c == '\n' ? std::string("\r\n") : std::string{c};
    expect_equal(read_mesh(folder.file("a.x", with_returns), 1),
                 read_mesh(folder.file("b.x", content), 1));
  }
}

TEST(MeshFile, scale_multiplies_positions) {
  const TestFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.msh", gmsh_4_ascii()), 0.001);
  Mesh expected = sample_mesh();
  for (Vec3& X : expected.X) X *= 0.001;
  expect_equal(mesh, expected);
}

TEST(MeshFile, an_unknown_format_is_refused_by_name) {
  const TestFolder folder;
  const std::string file = folder.file("a.dat", "0 0 0\n");
  EXPECT_EQ(
      error_of([&] { read_mesh(file, 1); }),
      file + ": is in no known mesh format: gmsh .msh (1.0, 2.2, 4.1), legacy VTK and VTU are");
}

TEST(MeshFile, a_missing_file_an_empty_file_and_a_directory_are_refused) {
  const TestFolder folder;
  EXPECT_EQ(error_of([&] { read_mesh(folder.file("none.msh"), 1); }),
            folder.file("none.msh") + ": there is no file of this name");
  EXPECT_EQ(error_of([&] { read_mesh(folder.file("empty.msh", ""), 1); }),
            folder.file("empty.msh") + ": is empty");
  EXPECT_EQ(error_of([&] { read_mesh(folder.file("."), 1); }),
            folder.file(".") + ": is a directory, not a file");
}

TEST(MeshFile, a_surface_file_is_known_by_its_ending_in_small_or_capital_letters) {
  for (const char* surface : {"a.stl", "folder/b.obj", "C.STL", "d.tip.Obj"})
    EXPECT_TRUE(is_surface_file(surface)) << surface;
  for (const char* other : {"a.msh", "stl", "a.stl.vtk", "", "obj.vtu"})
    EXPECT_FALSE(is_surface_file(other)) << other;
}

TEST(MeshFile, a_surface_file_is_no_volume_mesh_but_an_instrument) {
  const TestFolder folder;
  const std::string file = folder.file("a.stl", stl_binary());
  EXPECT_EQ(error_of([&] { read_mesh(file, 1); }),
            file +
                ": this file holds only a surface (4 triangles): make a volume mesh of it "
                "(docs/howto.md says how), or use it as an instrument");
  EXPECT_EQ(read_triangle_mesh(file, 1).triangle.size(), 4U);
}

TEST(MeshFile, the_surface_elements_of_a_volume_format_make_an_instrument) {
  const TestFolder folder;
  const std::string file = folder.file(
      "a.vtk",
      vtk_head("3.0", "ASCII") +
          "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
          "3 0 3 2\nCELL_TYPES 4\n5 5 5 5\n");
  const TriangleMesh mesh = read_triangle_mesh(file, 2);
  EXPECT_EQ(mesh.triangle.size(), 4U);
  ASSERT_EQ(mesh.X.size(), 4U);
  EXPECT_EQ(mesh.X[1], Vec3(0, 2, 0));  // by first use: the first triangle is 0 2 1
  EXPECT_NE(error_of([&] { read_mesh(file, 1); }).find("only a surface (4 triangles)"),
            std::string::npos);
}

TEST(MeshFile, a_volume_mesh_is_no_instrument) {
  const TestFolder folder;
  const std::string file = folder.file("a.msh", gmsh_2_ascii());
  EXPECT_EQ(error_of([&] { read_triangle_mesh(file, 1); }),
            file +
                ": holds volume elements (the first is gmsh tag 2); save only its surface, e.g. as "
                "STL or OBJ");
}

}  // namespace
}  // namespace trocar::test
