#include "collision/hull_bullet.h"

#include <limits>

#include "collision_random.h"

namespace trocar {
namespace {

std::vector<Vec3> random_box(Random& random, double size) {
  const Quat rotation = random.rotation();
  const Vec3 centre = random.in_box(size), half = random.in_box(size / 2);
  std::vector<Vec3> corners;
  for (const int i : {-1, 1})
    for (const int j : {-1, 1})
      for (const int k : {-1, 1})
        corners.push_back(centre + rotation * half.cwiseProduct(Vec3(i, j, k)));
  return corners;
}

// How far the triangle must move along d to be free of the hull.
double width(const Vec3& d, const std::vector<Vec3>& hull, const Triangle& x) {
  double high = -std::numeric_limits<double>::max(), low = -high;
  for (const Vec3& p : hull) high = std::max(high, d.dot(p));
  for (const Vec3& p : x) low = std::min(low, d.dot(p));
  return high - low;
}

TEST(HullShape, separated_pairs_satisfy_the_optimality_condition) {
  Random random(1);
  int n = 0, n_unproven = 0;
  for (int k = 0; k < 50000; ++k) {
    const std::vector<Vec3> box = random_box(random, 0.01);
    const Triangle x = random.triangle(0.02);
    const auto pair = HullShape(box).closest(x);
    if (!pair) ++n_unproven;
    if (!pair || pair->distance <= 0) continue;
    ++n;
    EXPECT_NEAR((pair->on_triangle.point - pair->on_hull).norm(), pair->distance, 1e-9);
    // The tolerance of hull_bullet.cpp: a nanometre is far below what a contact feels. Bullet alone
    // fails about 1 in 30,000 of these. Nearer than 100 nm the direction is rounding.
    if (pair->distance < 1e-7) continue;
    expect_nearest(pair->on_hull, box, pair->on_triangle.point, x, 1e-9);
  }
  EXPECT_GT(n, 20000);
  EXPECT_LE(n_unproven, 10);  // expected: less than one
}

TEST(HullShape, penetration_is_the_least_width_over_all_directions) {
  Random random(2);
  std::vector<Vec3> directions;
  for (int k = 0; k < 2000; ++k) directions.push_back(random.direction());
  int n = 0;
  for (int k = 0; k < 2000; ++k) {
    const std::vector<Vec3> box = random_box(random, 0.01);
    const Triangle x = random.triangle(0.01);
    const auto pair = HullShape(box).closest(x);
    ASSERT_TRUE(pair.has_value());
    if (pair->distance >= -1e-9) continue;
    ++n;
    EXPECT_NEAR(width(pair->normal, box, x), -pair->distance, 1e-9);
    for (const Vec3& d : directions) EXPECT_GE(width(d, box, x), -pair->distance - 1e-9);
  }
  EXPECT_GT(n, 300);
}

TEST(HullShape, gives_the_same_bits_whatever_was_asked_before) {
  Random random(3);
  std::vector<std::vector<Vec3>> boxes;
  std::vector<Triangle> triangles;
  for (int k = 0; k < 40; ++k) {
    boxes.push_back(random_box(random, 0.01));
    triangles.push_back(random.triangle(0.015));
  }
  std::vector<HullShape> hulls;
  for (const auto& box : boxes) hulls.emplace_back(box);
  const auto ask = [&](std::size_t k) { return *hulls[k % 40].closest(triangles[k / 40]); };
  std::vector<HullPair> forward(1600);
  for (std::size_t k = 0; k < 1600; ++k) forward[k] = ask(k);
  for (std::size_t k = 1600; k-- > 0;) {
    const HullPair again = ask(k);
    EXPECT_EQ(again.distance, forward[k].distance);
    EXPECT_EQ(again.on_hull, forward[k].on_hull);
    EXPECT_EQ(again.normal, forward[k].normal);
    EXPECT_EQ(again.on_triangle.weight, forward[k].on_triangle.weight);
  }
}

TEST(HullShape, of_two_points_agrees_with_the_closed_form) {
  Random random(4);
  for (int k = 0; k < 3000; ++k) {
    const Segment s = {random.in_box(0.02), random.in_box(0.02)};
    const Triangle x = random.triangle(0.02);
    const auto pair = HullShape({s[0], s[1]}).closest(x);
    const double distance = std::sqrt(closest_points_segment_triangle(s, x).distance2);
    if (distance == 0) continue;  // the two give different things there
    ASSERT_TRUE(pair.has_value());
    EXPECT_NEAR(pair->distance, distance, 1e-9);  // as above
  }
}

}  // namespace
}  // namespace trocar
