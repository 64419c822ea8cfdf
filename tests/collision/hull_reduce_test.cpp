#include "collision/hull_reduce.h"

#include <algorithm>

#include "collision_random.h"

namespace trocar {
namespace {

double reach_along(const std::vector<Vec3>& points, const Vec3& d) {
  double high = d.dot(points[0]);
  for (const Vec3& p : points) high = std::max(high, d.dot(p));
  return high;
}

TEST(ReduceHull, keeps_up_to_64_points_as_they_are) {
  Random random(1);
  std::vector<Vec3> points;
  for (int k = 0; k < 64; ++k) points.push_back(random.in_box(1));
  EXPECT_EQ(reduce_hull(points), points);
}

TEST(ReduceHull, keeps_the_corners_of_a_filled_box) {
  Random random(2);
  std::vector<Vec3> points;
  for (int k = 0; k < 500; ++k) points.push_back(random.in_box(0.9));
  for (const int i : {-1, 1})
    for (const int j : {-1, 1})
      for (const int k : {-1, 1}) points.emplace_back(i, j, k);
  const std::vector<Vec3> reduced = reduce_hull(points);
  EXPECT_EQ(reduced, std::vector<Vec3>(points.end() - 8, points.end()));
}

TEST(ReduceHull, of_a_sphere_loses_at_most_seven_percent_of_its_radius) {
  Random random(3);
  std::vector<Vec3> points;
  for (int k = 0; k < 4000; ++k) points.push_back(random.direction());
  const std::vector<Vec3> reduced = reduce_hull(points);
  EXPECT_EQ(reduced.size(), max_hull_points);
  // 64 caps that cover a sphere have an angle a with 64 (1 - cos a) / 2 >= 1 / 0.83 (the best
  // covering density in the plane, 1.21): 1 - cos a >= 0.038. Farthest points come close to it.
  for (int k = 0; k < 2000; ++k) {
    const Vec3 d = random.direction();
    EXPECT_GT(reach_along(reduced, d), 0.93 * reach_along(points, d));
  }
}

}  // namespace
}  // namespace trocar
