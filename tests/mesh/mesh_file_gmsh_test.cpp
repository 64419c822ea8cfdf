// What gmsh files may hold beside the small sample, and what is wrong with bad ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "mesh/mesh_file.h"
#include "mesh_equal.h"
#include "mesh_refusal.h"
#include "mesh_sample_files.h"
#include "replaced.h"
#include "test_files.h"

namespace trocar::test {
namespace {

constexpr const char* head_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

// "14:" if `what` begins in the 14th line.
std::string line_of(const std::string& what, const std::string& content) {
  const auto at = static_cast<std::ptrdiff_t>(content.find(what));
  return std::to_string(1 + std::count(content.begin(), content.begin() + at, '\n')) + ":";
}

std::string gmsh_refusal(const std::string& content) {
  return refusal_by(read_mesh, "a.msh", content);
}

Mesh gmsh_mesh(const std::string& content) {
  const TestFolder folder;
  return read_mesh(folder.file("a.msh", content), 1);
}

TEST(GmshFile, unknown_sections_are_passed_over) {
  const std::string extra =
      "$Comments\nanything 1 2 $ 3\n$EndComments\n$Periodic\n0\n$EndPeriodic\n";
  expect_equal(gmsh_mesh(replaced(gmsh_4_ascii(), "$Nodes", extra + "$Nodes")), sample_mesh());
}

TEST(GmshFile, nodes_of_a_physical_point_and_line_become_node_sets) {
  const Mesh mesh = gmsh_mesh(std::string(head_2) +
                              "$PhysicalNames\n1\n0 9 \"tip \"of\" it\"\n$EndPhysicalNames\n"
                              "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
                              "$Elements\n3\n1 15 2 9 1 4\n2 1 2 5 1 3 1\n3 4 2 0 1 1 2 3 4\n"
                              "$EndElements\n");
  ASSERT_EQ(mesh.node_sets.size(), 2U);
  EXPECT_EQ(mesh.node_sets[0].name, "tip \"of\" it");
  EXPECT_EQ(mesh.node_sets[0].node, std::vector<std::int32_t>{3});
  EXPECT_EQ(mesh.node_sets[1].name, "line-5");
  EXPECT_EQ(mesh.node_sets[1].node, (std::vector<std::int32_t>{0, 2}));
}

TEST(GmshFile, a_node_is_in_every_group_of_its_entity) {
  const std::string content =
      replaced(gmsh_4_ascii(), "4 0 0 0 1 1 0 1 3 0", "4 0 0 0 1 1 0 2 3 8 0");
  const Mesh mesh = gmsh_mesh(content);
  ASSERT_EQ(mesh.node_sets.size(), 2U);
  EXPECT_EQ(mesh.node_sets[1].name, "surface-8");
  EXPECT_EQ(mesh.node_sets[0].node, mesh.node_sets[1].node);
}

TEST(GmshFile, an_element_of_two_regions_is_refused) {
  const std::string content =
      replaced(gmsh_4_ascii(), "2 0 0 0 1 1 1 1 5 0", "2 0 0 0 1 1 1 2 5 2 0");
  EXPECT_EQ(
      gmsh_refusal(content),
      " some elements belong to two physical groups, \"tumor\" and \"tissue\"; an element has "
      "one region only");
}

TEST(GmshFile, elements_without_a_group_make_a_region_without_a_name) {
  const Mesh mesh = gmsh_mesh(replaced(gmsh_2_ascii(), "2 4 2 2 1", "2 4 2 0 1"));
  EXPECT_EQ(mesh.region_name, (std::vector<std::string>{"tissue", "tumor", ""}));
  EXPECT_EQ(mesh.element_region, (std::vector<std::int32_t>{2, 1}));
}

TEST(GmshFile, the_only_region_has_no_name_if_the_file_gives_none) {
  const std::string content = replaced(gmsh_1(), "3 4 5 1 4", "3 4 2 1 4");
  EXPECT_EQ(gmsh_mesh(content).region_name, std::vector<std::string>{""});
}

TEST(GmshFile, tags_may_be_negative_and_far_apart) {
  std::string content = gmsh_4_ascii();
  for (int k = 0; k < 4; ++k)  // its own node line and three elements
    content = replaced(content, k == 0 ? "\n20\n" : " 20 7",
                       k == 0 ? "\n-9000000000000\n" : " -9000000000000 7");
  expect_equal(gmsh_mesh(content), sample_mesh());
}

TEST(GmshFile, hexahedra_are_read) {
  const Mesh mesh =
      gmsh_mesh(std::string(head_2) +
                "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 2\n6 1 0 2\n7 1 "
                "1 2\n8 0 1 2\n$EndNodes\n"
                "$Elements\n1\n1 5 0 1 2 3 4 5 6 7 8\n$EndElements\n");
  ASSERT_EQ(mesh.n_elements(), 1);
  EXPECT_EQ(mesh.element_type[0], ElementType::hex8);
  EXPECT_EQ(element_volume(mesh, 0, mesh.X), 2);  // exact in double
}

TEST(GmshFile, bad_values_are_named_with_their_line) {
  const std::string line = line_of("7 0 1 0", gmsh_2_ascii());
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "7 0 1 0", "7 0 nan 0")),
            line + " y is \"nan\", not finite");
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "7 0 1 0", "7 0 1e999 0")),
            line + " y is \"1e999\", which no double can hold");
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "7 0 1 0", "7 0 1,5 0")),
            line + " y should be a number, not \"1,5\"");
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "7 0 1 0", "7.5 0 1 0")),
            line + " a node number should be an integer, not \"7.5\"");
}

TEST(GmshFile, tags_that_occur_twice_are_refused) {
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "\n99 7", "\n10 7")), " node 10 is listed twice");
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "\n3 4 2 5", "\n2 4 2 5")),
            " element 2 is listed twice");
}

TEST(GmshFile, an_element_that_refers_to_a_missing_node_is_named) {
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_2_ascii(), "20 7 40 50", "20 7 40 51")),
            line_of("3 4 2 5", gmsh_2_ascii()) +
                " element 3 refers to node 51, which the file doesn't have");
}

TEST(GmshFile, elements_of_other_kinds_are_named) {
  EXPECT_EQ(
      gmsh_refusal(replaced(gmsh_2_ascii(), "\n3 4 2 5 1", "\n3 11 2 5 1")),
      line_of("3 4 2 5", gmsh_2_ascii()) +
          " element 3 is of second order (gmsh type 11); triangles, tetrahedra and hexahedra of "
          "first order are read (types 2, 4, 5)");
  EXPECT_EQ(gmsh_refusal(replaced(gmsh_4_ascii(), "3 2 4 1\n3 20", "3 2 6 1\n3 20")),
            line_of("3 20 7 40 50", gmsh_4_ascii()) +
                " element 3 is a prism (gmsh type 6); triangles, tetrahedra and hexahedra of first "
                "order are read (types 2, 4, 5)");
}

TEST(GmshFile, counts_that_do_not_fit_are_refused) {
  const std::string content = replaced(gmsh_2_ascii(), "$Nodes\n6", "$Nodes\n1000");
  const std::size_t n_left = content.size() - content.find("1000") - 4;
  EXPECT_EQ(gmsh_refusal(content), line_of("1000", content) +
                                       " 1000 nodes are announced, but the file goes on for only " +
                                       std::to_string(n_left) + " bytes");
  EXPECT_NE(gmsh_refusal(replaced(gmsh_4_ascii(), "$Nodes\n2 6", "$Nodes\n2 7"))
                .find("7 nodes are announced, but the blocks hold 6"),
            std::string::npos);
  EXPECT_NE(gmsh_refusal(replaced(gmsh_4_ascii(), "$Elements\n3 3", "$Elements\n3 2"))
                .find("a block of 1 elements, but only 0 are left of the announced number"),
            std::string::npos);
}

TEST(GmshFile, the_other_byte_order_is_named_with_its_byte) {
  std::string content = gmsh_2_binary();
  const auto mark = content.begin() + std::strlen("$MeshFormat\n2.2 1 8\n");
  std::reverse(mark, mark + 4);
  EXPECT_NE(gmsh_refusal(content).find("other byte order"), std::string::npos);
}

TEST(GmshFile, a_binary_failure_names_its_byte) {
  std::string content = gmsh_4_binary();
  // 50 is the last node of the last element, whose 8 bytes stand before "\n$EndElements\n".
  const std::size_t at = content.size() - std::string("\n$EndElements\n").size() - 8;
  content[at] = 51;
  EXPECT_EQ(
      gmsh_refusal(content),
      " byte " + std::to_string(at) + ": element 3 refers to node 51, which the file doesn't have");
}

TEST(GmshFile, other_versions_are_named) {
  EXPECT_EQ(gmsh_refusal("$MeshFormat\n4 0 8\n$EndMeshFormat\n"),
            "2: gmsh format \"4\" is not read; save it as 4.1 or 2.2 (gmsh -save -format msh41)");
}

TEST(GmshFile, elements_before_nodes_are_refused) {
  EXPECT_EQ(gmsh_refusal(std::string(head_2) + "$Elements\n0\n$EndElements\n"),
            "4: the elements stand before the nodes");
}

TEST(GmshFile, zero_elements_are_refused) {
  EXPECT_EQ(gmsh_refusal(std::string(head_2) +
                         "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n0\n$EndElements\n"),
            " holds no elements (0 lines and 0 points): a mesh is made of tetrahedra, hexahedra or "
            "plane triangles");
}

}  // namespace
}  // namespace trocar::test
