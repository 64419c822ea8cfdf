// Meshes as other programs write them. Their counts stand in LICENCES.md beside them.
#include <gtest/gtest.h>

#include <map>

#include "mesh/mesh_file.h"
#include "mesh/quality.h"
#include "real_file.h"

namespace trocar::test {
namespace {

void expect_volume_mesh(const std::string& name, std::int32_t n_nodes, std::int32_t n_elements,
                        double least_quality) {
  const std::string file = real_file(name);
  if (file.empty()) GTEST_SKIP() << name << " is not beside the checkout";
  const Mesh mesh = read_mesh(file, 1);
  EXPECT_EQ(mesh.n_nodes(), n_nodes);
  EXPECT_EQ(mesh.n_elements(), n_elements);
  EXPECT_TRUE(validate(mesh).empty());
  // Two digits are given; the liver's 0.1847 (computed apart from this program) stands there as
  // 0.19.
  EXPECT_NEAR(mesh_statistics(mesh).quality_min, least_quality, 0.006);
}

// In a closed surface that is turned one way, each edge is used once in each direction.
bool is_watertight(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> n_uses;
  for (const auto& t : mesh.triangle)
    for (std::size_t a = 0; a < 3; ++a) ++n_uses[{t[a], t[(a + 1) % 3]}];
  for (const auto& [edge, n] : n_uses) {
    const auto back = n_uses.find({edge.second, edge.first});
    if (n != 1 || back == n_uses.end() || back->second != 1) return false;
  }
  return true;
}

void expect_surface(const std::string& name, std::size_t n_vertices, std::size_t n_triangles) {
  const std::string file = real_file(name);
  if (file.empty()) GTEST_SKIP() << name << " is not beside the checkout";
  const TriangleMesh mesh = read_triangle_mesh(file, 0.001);
  EXPECT_EQ(mesh.X.size(), n_vertices);
  EXPECT_EQ(mesh.triangle.size(), n_triangles);
  EXPECT_TRUE(is_watertight(mesh));
}

TEST(RealMesh, liver_in_gmsh_1_is_read) {
  expect_volume_mesh("sofa_liver.msh", 181, 596, 0.19);
}
TEST(RealMesh, tissue_flap_in_gmsh_2_is_read) {
  expect_volume_mesh("sofaenv_tissue_flap.msh", 493, 1432, 0.47);
}
TEST(RealMesh, cylinder_in_legacy_vtk_is_read) {
  expect_volume_mesh("sofa_cylinder_pdms.vtk", 3668, 12724, 0.53);
}
TEST(RealMesh, gallbladder_in_stl_is_watertight_after_merging) {
  expect_surface("sofaenv_gallbladder.stl", 7352, 14700);
}
TEST(RealMesh, jaw_in_stl_is_watertight_after_merging) {
  expect_surface("sofaenv_maryland_jaw_left.stl", 478, 952);
}
TEST(RealMesh, liver_surface_in_obj_is_watertight) {
  expect_surface("sofa_liver_surface.obj", 2194, 4384);
}
TEST(RealMesh, spot_in_obj_is_watertight) {
  expect_surface("spot.obj", 2930, 5856);
}

}  // namespace
}  // namespace trocar::test
