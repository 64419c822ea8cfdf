// Cells and arrays of legacy VTK files.
#include <gtest/gtest.h>

#include "error_of.h"
#include "mesh/mesh_file.h"
#include "mesh_refusal.h"
#include "mesh_sample_files.h"
#include "test_files.h"

namespace trocar::test {
namespace {

const std::string cube_points = "POINTS 8 float\n0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\n";

std::string vtk_refusal(const std::string& content) {
  return refusal_by(read_mesh, "a.vtk", content);
}

Mesh vtk_mesh(const std::string& content) {
  const TestFolder folder;
  return read_mesh(folder.file("a.vtk", content), 1);
}

std::string ascii(const std::string& rest) {
  return vtk_head("3.0", "ASCII") + rest;
}

TEST(LegacyVtk, a_voxel_is_a_hexahedron_in_another_order) {
  const Mesh mesh =
      vtk_mesh(ascii(cube_points + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n11\n"));
  ASSERT_EQ(mesh.n_elements(), 1);
  EXPECT_EQ(mesh.element_type[0], ElementType::hex8);
  EXPECT_EQ(element_volume(mesh, 0, mesh.X), 1);  // sums of integers: exact
  EXPECT_EQ(mesh.corner_node, (std::vector<std::int32_t>{0, 1, 3, 2, 4, 5, 7, 6}));
}

TEST(LegacyVtk, vertices_and_lines_are_left_out) {
  const Mesh mesh = vtk_mesh(ascii(
      cube_points +
      "CELLS 4 16\n1 0\n4 0 1 2 3\n3 0 1 2\n4 0 1 2 4\nCELL_TYPES 4\n1\n4\n4\n10\nPOINT_DATA 8\n"));
  EXPECT_EQ(mesh.n_elements(), 1);
  EXPECT_EQ(mesh.n_nodes(), 4);
}

const std::string two_tetrahedra =
    "POINTS 5 float\n0 0 0 1 0 0 0 1 0 0 0 1 0 0 -1\nCELLS 2 10\n4 0 1 2 3\n4 0 2 1 4\nCELL_TYPES "
    "2\n10 10\n";

// As ParaView, gmsh and meshio write them.
TEST(LegacyVtk, regions_and_fibres_are_read_from_arrays_and_fields_of_cells) {
  for (const std::string arrays :
       {"SCALARS region int 1\nLOOKUP_TABLE default\n7\n0\nVECTORS fibre double\n0 0 2 1 0 0\n",
        "FIELD FieldData 2\nregion 1 2 double\n7 0\nfibre 3 2 float\n0 0 2 1 0 0\n"}) {
    const Mesh mesh = vtk_mesh(ascii(two_tetrahedra + "CELL_DATA 2\n" + arrays));
    ASSERT_EQ(mesh.n_elements(), 2);
    EXPECT_EQ(mesh.region_name[mesh.element_region[0]], "region-7");
    EXPECT_EQ(mesh.region_name[mesh.element_region[1]], "region-0");
    EXPECT_EQ(mesh.fibre, (std::vector<Vec3>{Vec3(0, 0, 1), Vec3(1, 0, 0)}));
  }
  // A triangle, which has no say, and two tetrahedra.
  const Mesh mesh =
      vtk_mesh(vtk_4_binary() + "\nCELL_DATA 3\nSCALARS region int\nLOOKUP_TABLE default\n" +
               std::string("\0\0\0\11\0\0\0\6\0\0\0\5", 12));
  EXPECT_EQ(mesh.region_name[mesh.element_region[0]], "region-6");
  EXPECT_EQ(mesh.region_name[mesh.element_region[1]], "region-5");
}

TEST(LegacyVtk, regions_that_are_none_are_named) {
  const auto with = [](const std::string& array) {
    return ascii(two_tetrahedra + "CELL_DATA 2\n" + array);
  };
  // Four lines of head, seven of points and cells, then CELL_DATA.
  EXPECT_EQ(vtk_refusal(with("SCALARS region int\n7 -1\n")),
            "13: region -1 is no whole number between 0 and 2147483646");
  EXPECT_EQ(vtk_refusal(with("FIELD f 1\nregion 1 3 int\n7 1 1\n")),
            "14: \"region\" is of 3 cells, but there are 2");
  EXPECT_EQ(vtk_mesh(with("SCALARS region float\n7 0.5\n")).region_name,
            std::vector<std::string>{""});
}

TEST(LegacyVtk, data_that_no_mesh_has_are_left_out_with_a_warning) {
  testing::internal::CaptureStderr();
  vtk_mesh(ascii(two_tetrahedra +
                 "CELL_DATA 2\nSCALARS label int\n7 1\nSCALARS region int\n7 1\nPOINT_DATA "
                 "5\nSCALARS region int\n1 1 1 1 1\n"));
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_NE(told.find("its cell data \"label\" and point data \"region\" are left out; read are "
                      "cell data called \"region\" (a whole number each) and \"fibre\""),
            std::string::npos)
      << told;
}

// A tetrahedron with every kind of data; `number` and `text` write those of an array.
template <class Number, class Text>
std::string with_data(const std::string& head, const Number& number, const Text& text) {
  const auto numbers = [&](int n, const std::string& type) {
    std::string all;
    for (int k = 0; k < n; ++k) all += number(type);
    return all + "\n";
  };
  return head + "CELL_DATA 1\nSCALARS a float 2\nLOOKUP_TABLE default\n" + numbers(2, "float") +
         "SCALARS b int\n" + numbers(1, "int") + "COLOR_SCALARS c 3\n" + numbers(3, "colour") +
         "FIELD f 2\ng 2 1 double\n" + numbers(2, "double") + "h 1 2 string\n" + text("two") +
         text("words here") + "POINT_DATA 4\nVECTORS d double\n" + numbers(12, "double") +
         "NORMALS e float\n" + numbers(12, "float") + "TENSORS i float\n" + numbers(36, "float") +
         "TEXTURE_COORDINATES j 2 float\n" + numbers(8, "float") + "LOOKUP_TABLE k 2\n" +
         numbers(8, "colour") +
         "METADATA\nINFORMATION 0\n\nGLOBAL_IDS l "
         "int\n" +
         numbers(4, "int");
}

std::string ascii_with_data() {
  return with_data(
      ascii("POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"),
      [](const std::string&) { return "1.5 "; },
      [](const std::string& text) { return text + "\n"; });
}

// A big-endian number of `n` bytes.
std::string big_endian(std::uint64_t value, int n) {
  std::string bytes;
  for (int k = n - 1; k >= 0; --k) bytes += static_cast<char>(value >> (8 * k));
  return bytes;
}

std::string binary_with_data() {
  std::string head = vtk_head("3.0", "BINARY") + "POINTS 4 char\n";
  head += std::string("\0\0\0\1\0\0\0\1\0\0\0\1", 12) + "\nCELLS 1 5\n";
  for (const std::uint64_t k : {4, 0, 1, 2, 3}) head += big_endian(k, 4);
  return with_data(
      head + "\nCELL_TYPES 1\n" + big_endian(10, 4) + "\n",
      [](const std::string& type) {
        return big_endian(7, type == "colour" ? 1 : type == "double" ? 8 : 4);
      },
      // The length in one byte or in two.
      [](const std::string& text) {
        const auto n = text.size();
        return (n < 4 ? big_endian(3 << 6 | n, 1) : big_endian(2 << 14 | n, 2)) + text;
      });
}

// Read are those that end behind one of nine arrays, before or behind the end of its line, but for
// the whole file; behind "POINT_DATA 4", behind "METADATA" and each of the 16 characters that
// follow it, and behind the texts. In ASCII also those within the last of "1.5 " and "words here",
// in binary the one that takes "LOOKUP_T" for two numbers.
TEST(LegacyVtk, a_file_cut_off_within_the_data_of_cells_or_points_is_refused) {
  constexpr int n_of_both = 2 * 9 - 1 + 2 + 17 + 1;
  for (const auto& [whole, expected] : {std::pair{ascii_with_data(), n_of_both + 3 * 9 + 10},
                                        {binary_with_data(), n_of_both + 1}}) {
    EXPECT_EQ(vtk_mesh(whole).n_elements(), 1);
    int n_read = 0;
    for (std::size_t n = whole.find("SCALARS") + 1; n < whole.size(); ++n) {
      const TestFolder folder;
      const std::string file = folder.file("a.vtk", whole.substr(0, n));
      n_read += error_of([&] { read_mesh(file, 1); }).empty() ? 1 : 0;
    }
    EXPECT_EQ(n_read, expected) << whole.size();
    EXPECT_NE(vtk_refusal(whole.substr(0, whole.find("NORMALS") + 30)), "");
  }
}

TEST(LegacyVtk, keywords_count_in_any_case) {
  EXPECT_EQ(vtk_mesh("# vtk DataFile Version 2.0\nt\nascii\ndataset unstructured_grid\n" +
                     cube_points + "cells 1 5\n4 0 1 2 4\ncell_types 1\n10\n")
                .n_elements(),
            1);
}

TEST(LegacyVtk, cells_that_do_not_fit_are_named) {
  // Four lines of head, two of points, CELLS in the 7th.
  EXPECT_EQ(vtk_refusal(ascii(cube_points + "CELLS 1 5\n4 0 1 2 8\nCELL_TYPES 1\n10\n")),
            " cell 0 refers to point 8, but the points run from 0 to 7");
  EXPECT_EQ(vtk_refusal(ascii(cube_points + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n1\n")),
            " cell 0 has 4 corners, which does not fit VTK type 1");
  EXPECT_EQ(
      vtk_refusal(ascii(cube_points + "CELLS 1 7\n6 0 1 2 3 4 5\nCELL_TYPES 1\n13\n")),
      " cell 0 is a prism (VTK type 13); triangles, tetrahedra, hexahedra and voxels are read "
      "(types 5, 10, 12, 11)");
  EXPECT_EQ(vtk_refusal(ascii(cube_points + "CELLS 1 5\n9 0 1 2 4\nCELL_TYPES 1\n10\n")),
            "8: cell 0 does not fit into the 5 numbers of CELLS");
  EXPECT_EQ(vtk_refusal(ascii(cube_points + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 2\n10 10\n")),
            " has 2 cell types, but 1 cells");
}

TEST(LegacyVtk, other_data_sets_are_named) {
  EXPECT_EQ(vtk_refusal("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"),
            "4: the data set is \"POLYDATA\"; only UNSTRUCTURED_GRID is read");
}

TEST(LegacyVtk, points_that_are_not_finite_are_refused_in_binary_data) {
  std::string content = vtk_4_binary();
  const std::size_t at = content.find("double\n") + 7;
  content.replace(at, 8, "\x7f\xf0\0\0\0\0\0\0", 8);  // big-endian infinity
  EXPECT_EQ(vtk_refusal(content), " byte " + std::to_string(at) + ": a coordinate is not finite");
}

}  // namespace
}  // namespace trocar::test
