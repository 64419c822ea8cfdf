// Some elements of a mesh as a mesh of their own.
#include "mesh/sub_mesh.h"

#include <gtest/gtest.h>

#include "mesh/quality.h"
#include "mesh_fixtures.h"

using namespace trocar;

TEST(SubMesh, has_the_elements_with_all_that_they_have) {
  Mesh mesh = mixed_mesh();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    mesh.density_factor[e] = 1 + e;
    mesh.fibre.push_back(Vec3(e, 0, 1));
  }
  std::vector<std::int32_t> some;
  for (std::int32_t e = 3; e < mesh.n_elements(); e += 7) some.push_back(e);
  const SubMesh sub = make_sub_mesh(mesh, some);
  EXPECT_EQ(sub.element, some);
  EXPECT_TRUE(std::is_sorted(sub.node.begin(), sub.node.end()));
  ASSERT_EQ(sub.mesh.n_elements(), std::ssize(some));
  for (std::int32_t k = 0; k < sub.mesh.n_elements(); ++k) {
    const std::int32_t e = some[k];
    EXPECT_EQ(sub.mesh.element_type[k], mesh.element_type[e]);
    EXPECT_EQ(sub.mesh.element_region[k], mesh.element_region[e]);
    EXPECT_EQ(sub.mesh.density_factor[k], mesh.density_factor[e]);
    EXPECT_EQ(sub.mesh.fibre[k], mesh.fibre[e]);
    ASSERT_EQ(sub.mesh.corners(k).size(), mesh.corners(e).size());
    for (std::size_t a = 0; a < mesh.corners(e).size(); ++a)
      EXPECT_EQ(sub.node[sub.mesh.corners(k)[a]], mesh.corners(e)[a]);
  }
  EXPECT_EQ(sub.mesh.region_name, mesh.region_name);
  EXPECT_EQ(values_of<Vec3>(mesh.X, sub.node), sub.mesh.X);
}
