#include "collision/narrow_phase.h"

#include "collision_random.h"
#include "collision_tool.h"

namespace trocar {
namespace {

// Outward is +z. Edges of 6 mm.
const Triangle face = {Vec3(0, 0, 0), Vec3(6e-3, 0, 0), Vec3(0, 6e-3, 0)};
constexpr double face_margin = 2e-3;

PieceCore sphere(const Vec3& centre) {
  return make_core({.points = {centre}, .radius = tool_radius});
}

PieceCore box(const Vec3& low, const Vec3& high, const Pose& pose = {}) {
  ConvexPiece piece;
  for (const double x : {low.x(), high.x()})
    for (const double y : {low.y(), high.y()})
      for (const double z : {low.z(), high.z()}) piece.points.push_back(pose.apply(Vec3(x, y, z)));
  return make_core(piece);
}

TEST(Touch, of_a_sphere_over_face_edge_and_vertex_has_the_closed_form_gap) {
  for (const auto& [centre, nearest] : {std::pair{Vec3(1e-3, 1e-3, 4e-3), Vec3(1e-3, 1e-3, 0)},
                                        std::pair{Vec3(2e-3, -3e-3, 4e-3), Vec3(2e-3, 0, 0)},
                                        std::pair{Vec3(-1e-3, -1e-3, 4e-3), Vec3(0, 0, 0)}}) {
    const auto found = touch(sphere(centre), face, face_margin);
    ASSERT_TRUE(found.has_value());
    const double distance = (nearest - centre).norm();
    EXPECT_NEAR(found->gap, distance - tool_radius, tool_rounding);
    EXPECT_NEAR((found->normal - (nearest - centre) / distance).norm(), 0, 1e-12);
    EXPECT_EQ(found->depth, 0);
  }
}

TEST(Touch, ends_where_the_gap_reaches_the_margin) {
  const double edge = tool_radius + face_margin;
  EXPECT_TRUE(touch(sphere(Vec3(1e-3, 1e-3, edge - 1e-9)), face, face_margin).has_value());
  EXPECT_FALSE(touch(sphere(Vec3(1e-3, 1e-3, edge + 1e-9)), face, face_margin).has_value());
}

TEST(Touch, of_a_triangle_without_area_is_none) {
  const Triangle line = {Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(3e-3, 0, 0)};
  EXPECT_FALSE(touch(sphere(Vec3(1e-3, 0, 1e-3)), line, face_margin).has_value());
}

TEST(Touch, pushes_along_the_inward_normal_when_the_centre_has_passed_the_face) {
  for (const double z : {-1e-12, -1e-4, -1e-3, -5e-3, -9e-3}) {
    const auto found = touch(sphere(Vec3(1e-3, 1e-3, z)), face, face_margin);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR((found->normal + Vec3::UnitZ()).norm(), 0,
                1e-3 * tool_rounding / -z + tool_rounding);
    EXPECT_NEAR(found->gap, z - tool_radius, tool_rounding);
    EXPECT_NEAR(found->depth, z < -1e-8 ? -z : 0, tool_rounding);
  }
}

TEST(Touch, is_lost_below_the_depth_limit) {
  const PieceCore any = sphere(Vec3::Zero());
  const double limit = depth_limit(any, face_margin);
  EXPECT_EQ(limit, 2 * tool_radius + face_margin);
  EXPECT_TRUE(touch(sphere(Vec3(1e-3, 1e-3, -limit + 1e-9)), face, face_margin).has_value());
  EXPECT_FALSE(touch(sphere(Vec3(1e-3, 1e-3, -limit - 1e-9)), face, face_margin).has_value());
}

// Force per stiffness: what the penalty law makes of a touch.
Vec3 push(const PieceCore& core) {
  const auto found = touch(core, face, face_margin);
  return found && found->gap < 0 ? Vec3(-found->gap * found->normal) : Vec3::Zero();
}

TEST(Touch, of_a_sphere_changes_smoothly_on_every_path_through_and_beside_the_triangle) {
  Random random(1);
  for (int path = 0; path < 50; ++path) {
    const Vec3 from(random.between(-8e-3, 8e-3), random.between(-8e-3, 8e-3), 6e-3);
    const Vec3 to(random.between(-8e-3, 8e-3), random.between(-8e-3, 8e-3), -6e-3);
    const double step = (to - from).norm() / 20000;
    Vec3 before = push(sphere(from));
    for (int k = 1; k <= 20000; ++k) {
      const Vec3 centre = from + (to - from) * (k / 20000.0);
      const Vec3 now = push(sphere(centre));
      // Direction d = (q - c) / |q - c| turns by step / |q - c|; near an edge at distance e the
      // force, below 2 r, changes by at most 2 r step / e. e < 50 um is too near to tell from a
      // jump with this step and is left out.
      const double e = (closest_point_triangle(centre, face).point - centre).norm();
      EXPECT_LE((now - before).norm(),
                e > 5e-5 ? 2 * step + 6 * tool_radius * step / e : 2 * tool_radius);
      before = now;
    }
  }
}

TEST(Touch, of_a_capsule_is_that_of_the_nearest_sphere_on_its_axis) {
  Random random(2);
  for (int k = 0; k < 500; ++k) {
    const Segment axis = {Vec3(random.in_box(8e-3) + Vec3(0, 0, 9e-3)),
                          Vec3(random.in_box(8e-3) + Vec3(0, 0, 9e-3))};
    const PieceCore capsule = make_core({.points = {axis[0], axis[1]}, .radius = tool_radius});
    const auto found = touch(capsule, face, 1.0);
    ASSERT_TRUE(found.has_value());
    double sampled = 1;
    for (int i = 0; i <= 2000; ++i)
      sampled = std::min(sampled, touch(sphere(point_at(axis, i / 2000.0)), face, 1.0)->gap);
    // The nearest sample is at most half a spacing away: 28 mm / 2000 / 2.
    EXPECT_LE(found->gap, sampled + tool_rounding);
    EXPECT_GE(found->gap, sampled - 7e-6);
  }
}

TEST(Touch, of_a_capsule_through_the_face_takes_the_deepest_point_below_it) {
  const PieceCore upright = make_core(
      {.points = {Vec3(1e-3, 1e-3, 30e-3), Vec3(1e-3, 1e-3, -2e-3)}, .radius = tool_radius});
  const auto tip = touch(upright, face, face_margin);
  ASSERT_TRUE(tip.has_value());
  EXPECT_NEAR(tip->gap, -2e-3 - tool_radius, tool_rounding);
  EXPECT_NEAR((tip->normal + Vec3::UnitZ()).norm(), 0, tool_rounding);
  // A flat shaft dips below the face; beneath x = 6 mm, where the face ends, it is 1 mm deep.
  const PieceCore flat =
      make_core({.points = {Vec3(-3e-3, 0, 2e-3), Vec3(24e-3, 0, -7e-3)}, .radius = tool_radius});
  const auto dip = touch(flat, face, face_margin);
  ASSERT_TRUE(dip.has_value());
  EXPECT_NEAR(dip->gap, -1e-3 - tool_radius, 1e-14);
  EXPECT_NEAR(dip->tissue.point.x(), 6e-3, 1e-14);
}

TEST(Touch, of_a_box_above_the_face_is_its_lowest_corner) {
  const PieceCore core = box(Vec3(1e-3, 1e-3, 5e-4), Vec3(2e-3, 2e-3, 9e-3));
  const auto found = touch(core, face, face_margin);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->gap, 5e-4, 1e-9);  // Bullet's tolerance, see hull_bullet_test
  EXPECT_NEAR((found->normal + Vec3::UnitZ()).norm(), 0, 1e-6);
}

TEST(Touch, of_a_thin_plate_pushes_the_face_to_its_own_side_however_deep) {
  // A blade of 0.4 mm that covers the triangle: EPA alone would push up from z < -0.2 mm on.
  for (const double low : {-0.1e-3, -0.19e-3, -0.21e-3, -0.3e-3, -0.39e-3}) {
    const PieceCore blade = box(Vec3(-1e-2, -1e-2, low), Vec3(1e-2, 1e-2, low + 0.4e-3));
    const auto found = touch(blade, face, face_margin);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->gap, low, 2e-9);  // cast_tolerance of 6 mm twice, and Bullet's
    EXPECT_NEAR((found->normal + Vec3::UnitZ()).norm(), 0, 1e-6);
  }
}

// How far below q the box reaches, by slabs; negative where it does not lie below.
double depth_below(const Vec3& q, const Vec3& half, const Quat& rotation, const Vec3& centre) {
  const Vec3 o = rotation.conjugate() * (q - centre), d = rotation.conjugate() * -Vec3::UnitZ();
  double enter = 0, leave = 1;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double a = (-half[i] - o[i]) / d[i], b = (half[i] - o[i]) / d[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? leave : -1;
}

// The plate's lower face is z = 0, and the tissue's outer side, about +x, ends `depth` above it.
TEST(Touch, of_a_plate_does_not_push_tissue_aside_that_ends_at_it) {
  const PieceCore plate = box(Vec3(-0.08, -0.08, 0), Vec3(0.08, 0.08, 0.01));
  Random random(1);
  for (const double depth : {1e-4, 1e-6, 1e-9, 1e-12, 0.0, -1e-9}) {
    for (int k = 0; k < 200; ++k) {
      const Vec3 top(random.between(-0.03, 0.03), random.between(-0.03, 0.03), depth);
      const Vec3 low = top + Vec3(random.between(-5e-4, 5e-4), random.between(0, 0.01), -0.01);
      const Vec3 along(random.between(-3e-4, 3e-4), 0.01, k % 2 == 0 ? 0 : -1e-3);
      const auto found = touch(plate, {top, low, top + along}, 4e-3);
      EXPECT_TRUE(!found || found->normal.z() < -0.5) << depth;
    }
    const auto above =
        touch(plate, {Vec3(0, 0, depth), Vec3(0.01, 0, depth), Vec3(0, 0.01, depth)}, 4e-3);
    ASSERT_TRUE(above) << depth;
    EXPECT_LT(above->normal.z(), -0.5) << depth;
  }
}

TEST(Touch, of_a_tilted_box_below_the_face_is_its_deepest_point_straight_below) {
  Random random(3);
  int n = 0;
  for (int k = 0; k < 300; ++k) {
    const Quat rotation = random.rotation();
    const Vec3 half = Vec3(3e-3, 2e-3, 4e-3), centre = random.in_box(3e-3) - Vec3(0, 0, 2e-3);
    const auto found = touch(box(-half, half, {rotation, centre}), face, face_margin);
    double sampled = -1;
    constexpr int m = 200;
    for (int i = 0; i <= m; ++i)
      for (int j = 0; i + j <= m; ++j)
        sampled =
            std::max(sampled, depth_below(Vec3(i, j, 0) * (6e-3 / m), half, rotation, centre));
    // Depth 0: in front, or an answer of EPA. No penetration: nothing of the box lies straight
    // below.
    if (!found || found->depth == 0 || found->gap >= 0) continue;
    ++n;
    EXPECT_GE(found->depth, sampled - 2e-9);
    // Sides steeper than 20 to 1 apart, the sampled one is at most a spacing of 30 um away.
    EXPECT_LE(found->depth, sampled + 20 * 6e-3 / m);
  }
  EXPECT_GT(n, 50);
}

TEST(Touch, normal_never_points_out_of_the_tissue) {
  Random random(4);
  for (int k = 0; k < 3000; ++k) {
    const Vec3 shift = random.in_box(8e-3);
    const PieceCore cores[] = {
        sphere(shift), make_core({.points = {shift, random.in_box(8e-3)}, .radius = tool_radius}),
        box(shift, shift + Vec3(3e-3, 4e-3, 5e-3), {.rotation = random.rotation()})};
    for (const PieceCore& core : cores) {
      const auto found = touch(core, face, 1e-3);
      if (!found) continue;
      EXPECT_LE(found->normal.z(), 1e-12);
      EXPECT_NEAR(found->normal.norm(), 1, 1e-12);
      const Vec3 q = at_weights(face, found->tissue.weight);
      EXPECT_NEAR((q - found->tissue.point).norm(), 0, 1e-11);
    }
  }
}

}  // namespace
}  // namespace trocar
