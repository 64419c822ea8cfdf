// What write_mesh writes, read_mesh reads.
#include "mesh_write.h"

#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "mesh/mesh_file.h"
#include "mesh_equal.h"
#include "mesh_fixtures.h"
#include "test_files.h"

namespace trocar::test {
namespace {

void expect_round_trip(const Mesh& mesh) {
  const TestFolder folder;
  write_mesh(mesh, folder.file("a.msh"));
  expect_equal(read_mesh(folder.file("a.msh"), 1), mesh);
}

Mesh box(BoxElements elements) {
  Mesh mesh = make_box(Vec3(-1, 0, 0.1), Vec3(1, 1. / 3, 1), {3, 2, 2}, elements);
  jitter(mesh, 0.2, 7);
  return mesh;
}

TEST(WriteMesh, tetrahedra_hexahedra_and_triangles_read_back_identical) {
  expect_round_trip(box(BoxElements::tet4_kuhn));
  expect_round_trip(box(BoxElements::hex8));
  expect_round_trip(make_rectangle(0.3, 0.1, 5, 4));
}

TEST(WriteMesh, mixed_elements_keep_their_order) {
  Mesh mesh;
  mesh.X = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
            {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0, 0, 2}, {2, 0, 0}};
  add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{4, 5, 7, 8});
  add_element(mesh, ElementType::hex8, std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7});
  add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{1, 9, 2, 5});
  expect_round_trip(mesh);
}

TEST(WriteMesh, regions_keep_their_names_and_numbers) {
  Mesh mesh = box(BoxElements::tet4_five);
  mesh.region_name = {"liver \"left\"", "", "a region without elements", "tumor"};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    mesh.element_region[e] = e % 5 == 0 ? 3 : e % 2;
  expect_round_trip(mesh);
}

TEST(WriteMesh, node_sets_that_overlap_or_are_empty_read_back_identical) {
  Mesh mesh = box(BoxElements::hex8);
  mesh.node_sets = {{"b", {0, 1, 2, 7}}, {"nothing", {}}, {"a", {1, 7, 8}}, {"b2", {0, 1, 2, 7}}};
  expect_round_trip(mesh);
}

}  // namespace
}  // namespace trocar::test
