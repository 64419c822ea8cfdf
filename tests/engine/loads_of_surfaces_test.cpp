// Loads on surfaces that a mesh file names.
#include <gtest/gtest.h>

#include <string>

#include "engine/loads.h"
#include "engine_started.h"
#include "replaced.h"
#include "test_files.h"

namespace trocar {
namespace {

Vec3 total_force(const Loads& loads) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : loads.force) sum += force;
  return sum;
}

// Three cubes in a row; the surface is the top of both outer ones, which has all nodes of the one
// between.
const char* const three_cubes = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 2 "strips"
$EndPhysicalNames
$Nodes
16
1 0 0 0
2 0.01 0 0
3 0.02 0 0
4 0.03 0 0
5 0 0.01 0
6 0.01 0.01 0
7 0.02 0.01 0
8 0.03 0.01 0
9 0 0 0.01
10 0.01 0 0.01
11 0.02 0 0.01
12 0.03 0 0.01
13 0 0.01 0.01
14 0.01 0.01 0.01
15 0.02 0.01 0.01
16 0.03 0.01 0.01
$EndNodes
$Elements
5
4 3 2 2 2 9 10 14 13
5 3 2 2 2 11 12 16 15
6 5 2 9 9 1 2 6 5 9 10 14 13
7 5 2 9 9 2 3 7 6 10 11 15 14
8 5 2 9 9 3 4 8 7 11 12 16 15
$EndElements
)";

TEST(Loads, act_on_the_facets_of_a_surface_in_the_file_alone) {
  const TestFolder folder;
  const auto cubes = built("[time]\nduration = 1\n[tissue]\nmesh = \"" +
                           write_text(folder.file("strips.msh"), three_cubes) +
                           "\"\n[tissue.material]\nyoung_modulus = 30000\n"
                           "[[load]]\nregion = \"strips\"\npressure = 100\n"
                           "[[load]]\nregion = \"strips\"\nforce = [0.3, 0, 0]\n");
  Simulation& s = *cubes->s;
  EXPECT_EQ(find_loaded_areas(s.scene.loads, s.mesh, s.surface).of_load[0].size(), 2U);
  find_loads(s.scene.loads, s.mesh, s.part, 1, 0, s.state.u, s.loads);
  EXPECT_LT((total_force(s.loads) - Vec3(0.3, 0, -100 * 2e-4)).norm(), 1e-12);
  for (std::size_t k = 0; k < s.loads.node.size(); ++k)  // a quarter of a face each
    EXPECT_NEAR(s.loads.force[k].z(), -100 * 1e-4 / 4, 1e-12) << s.loads.node[k];
  EXPECT_EQ(s.loads.node.size(), 8U);
}

// Half a cell's area beside the two faces above.
TEST(Loads, act_on_triangles_and_quads_of_one_surface) {
  const TestFolder folder;
  std::string mesh = replaced(three_cubes, "$Nodes\n16", "$Nodes\n20");
  mesh = replaced(mesh, "$EndNodes",
                  "17 0.05 0 0.01\n18 0.06 0 0.01\n19 0.05 0.01 0.01\n20 0.05 0 0\n$EndNodes");
  mesh = replaced(mesh, "$Elements\n5", "$Elements\n7");
  mesh = replaced(mesh, "$EndElements", "9 2 2 2 2 17 18 19\n10 4 2 9 9 17 19 18 20\n$EndElements");
  const auto cubes = built("[time]\nduration = 1\n[tissue]\nmesh = \"" +
                           write_text(folder.file("strips.msh"), mesh) +
                           "\"\n[tissue.material]\nyoung_modulus = 30000\n"
                           "[[load]]\nregion = \"strips\"\npressure = 100\n");
  Simulation& s = *cubes->s;
  find_loads(s.scene.loads, s.mesh, s.part, 1, 0, s.state.u, s.loads);
  EXPECT_LT((total_force(s.loads) - Vec3(0, 0, -100 * 2.5e-4)).norm(), 1e-12);
}

}  // namespace
}  // namespace trocar
