#include "collision/closest_point.h"

#include "collision_random.h"

namespace trocar {
namespace {

constexpr double rounding = 1e-13;  // of coordinates of size 1
const Triangle corner = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};

void expect_point(const Vec3& p, const Vec3& expected) {
  const TrianglePoint q = closest_point_triangle(p, corner);
  EXPECT_NEAR((q.point - expected).norm(), 0, rounding) << p.transpose();
}

TEST(ClosestPointTriangle, is_found_in_face_edge_and_vertex_regions) {
  expect_point(Vec3(0.5, 0.5, 3), Vec3(0.5, 0.5, 0));
  expect_point(Vec3(0.5, 0.5, -3), Vec3(0.5, 0.5, 0));
  expect_point(Vec3(1, -1, 1), Vec3(1, 0, 0));
  expect_point(Vec3(-1, 1, 1), Vec3(0, 1, 0));
  expect_point(Vec3(2, 2, 1), Vec3(1, 1, 0));
  expect_point(Vec3(-1, -1, 1), Vec3(0, 0, 0));
  expect_point(Vec3(4, -1, 1), Vec3(2, 0, 0));
  expect_point(Vec3(-1, 4, 1), Vec3(0, 2, 0));
}

TEST(ClosestPointTriangle, satisfies_the_optimality_condition_for_random_points) {
  Random random(1);
  for (int k = 0; k < 20000; ++k) {
    const Triangle x = random.triangle(1);
    const Vec3 p = random.in_box(2);
    const TrianglePoint q = closest_point_triangle(p, x);
    EXPECT_NEAR(q.weight[0] + q.weight[1] + q.weight[2], 1, rounding);
    for (const double w : q.weight) EXPECT_GE(w, 0);
    EXPECT_NEAR((at_weights(x, q.weight) - q.point).norm(), 0, rounding);
    // Flat triangles amplify rounding by their aspect ratio, up to 1e4 among these.
    expect_nearest(p, std::array{p}, q.point, x, 1e-9);
  }
}

// Contact divides by the weights of free nodes: one of -1e-17 threw a node to infinity.
TEST(ClosestPointTriangle, has_no_negative_weight_beside_an_edge) {
  Random random(2);
  for (int k = 0; k < 20000; ++k) {
    const Triangle x = random.triangle(1);
    const double t = random.in_box(1).cwiseAbs().maxCoeff();
    const Vec3 above = 0.1 * (x[1] - x[0]).cross(x[2] - x[0]);
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3 p = x[a] + t * (x[(a + 1) % 3] - x[a]) + above;
      for (const double w : closest_point_triangle(p, x).weight) ASSERT_GE(w, 0) << k;
    }
  }
}

TEST(ClosestPointTriangle, of_a_triangle_without_area_is_that_of_its_longest_edge) {
  const Triangle line = {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(3, 3, 3)};
  const TrianglePoint q = closest_point_triangle(Vec3(2, 2, 5), line);
  EXPECT_NEAR((q.point - Vec3(3, 3, 3)).norm(), 0, rounding);
  const Triangle dot = {Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)};
  EXPECT_EQ(closest_point_triangle(Vec3(2, 2, 5), dot).point, Vec3(1, 1, 1));
}

TEST(ClosestPointsSegments, satisfy_the_optimality_condition_for_random_segments) {
  Random random(2);
  for (int k = 0; k < 20000; ++k) {
    const Segment a = {random.in_box(1), random.in_box(1)};
    // Every fourth is parallel, every fourth a point.
    Segment b = {random.in_box(1), random.in_box(1)};
    if (k % 4 == 1) b[1] = b[0] + random.between(-2, 2) * (a[1] - a[0]);
    if (k % 4 == 2) b[1] = b[0];
    const SegmentPair pair = closest_points_segments(a, b);
    EXPECT_NEAR((point_at(a, pair.s) - pair.first).norm(), 0, rounding);
    EXPECT_NEAR((point_at(b, pair.t) - pair.second).norm(), 0, rounding);
    // Nearly parallel segments lose half of the digits of s and t: 1e-16 / sqrt(1e-14) = 1e-9.
    expect_nearest(pair.first, a, pair.second, b, 1e-8);
  }
}

TEST(ClosestPointsSegmentTriangle, satisfy_the_optimality_condition_or_cross) {
  Random random(3);
  int n_crossing = 0;
  for (int k = 0; k < 20000; ++k) {
    const Triangle x = random.triangle(1);
    const Segment s = {random.in_box(1.5), random.in_box(1.5)};
    const SegmentTrianglePair pair = closest_points_segment_triangle(s, x);
    expect_nearest(pair.on_segment, s, pair.on_triangle.point, x, 1e-8);
    if (pair.distance2 > 0) continue;
    ++n_crossing;
    EXPECT_NEAR((pair.on_segment - pair.on_triangle.point).norm(), 0, 1e-10);
  }
  EXPECT_GT(n_crossing, 500);  // about one in twenty crosses
}

TEST(PartOverTriangle, is_the_part_whose_projection_lies_in_the_triangle) {
  const Segment s = {Vec3(-1, 0.5, 1), Vec3(3, 0.5, -1)};
  const auto part = part_over_triangle(s, corner, Vec3::UnitZ());
  ASSERT_TRUE(part.has_value());
  EXPECT_NEAR(point_at(s, part->t0).x(), 0, rounding);    // enters through x = 0
  EXPECT_NEAR(point_at(s, part->t1).x(), 1.5, rounding);  // leaves through x + y = 2
  const Segment beside = {Vec3(-1, -0.5, 1), Vec3(3, -0.5, -1)};
  EXPECT_FALSE(part_over_triangle(beside, corner, Vec3::UnitZ()).has_value());
}

}  // namespace
}  // namespace trocar
