#include "mesh/barycentric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace trocar {
namespace {

const std::vector<Vec3> nodes = {{0.1, 0, 0}, {1, 0.2, 0}, {0, 1.5, 0}, {0.3, 0.3, 2}};
const std::vector<std::int32_t> tetrahedron = {2, 0, 1, 3}, triangle = {1, 2, 0};

TEST(Barycentric, weights_give_the_point_and_sum_to_one) {
  for (const std::vector<std::int32_t>& corner : {tetrahedron, triangle})
    for (const Vec3& p : {Vec3(0.4, 0.5, 0.3), Vec3(-1, 2, 0.7), Vec3(0.4, 0.5, 0)}) {
      if (corner.size() == 3 && p.z() != 0) continue;
      const std::array<double, 4> weight = barycentric(corner, nodes, p);
      Vec3 sum = Vec3::Zero();
      for (std::size_t a = 0; a < corner.size(); ++a) sum += weight[a] * nodes[corner[a]];
      EXPECT_LT((sum - p).norm(), 1e-14);
      EXPECT_EQ(interpolate(corner, weight, nodes), sum);
      EXPECT_NEAR(weight[0] + weight[1] + weight[2] + weight[3], 1, 1e-14);
      if (corner.size() == 3) {
        EXPECT_EQ(weight[3], 0);
      }
    }
}

TEST(Barycentric, weight_is_one_at_its_corner_and_negative_beyond_the_side_across) {
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3& X = nodes[tetrahedron[a]];
    EXPECT_NEAR(barycentric(tetrahedron, nodes, X)[a], 1, 1e-14);
    Vec3 middle = Vec3::Zero();
    for (std::size_t b = 0; b < 4; ++b)
      if (b != a) middle += nodes[tetrahedron[b]] / 3;
    EXPECT_NEAR(barycentric(tetrahedron, nodes, middle)[a], 0, 1e-14);
    EXPECT_LT(barycentric(tetrahedron, nodes, middle + 0.1 * (middle - X))[a], 0);
  }
}

TEST(Barycentric, of_a_flat_tetrahedron_is_no_number) {
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_TRUE(std::isnan(barycentric(tetrahedron, flat, Vec3(0.3, 0.3, 0))[1]));
}

}  // namespace
}  // namespace trocar
