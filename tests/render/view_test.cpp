#include "render/view.h"

#include <gtest/gtest.h>

using namespace trocar;

TEST(View, matrix_and_projected_pixel_agree) {
  const Camera camera{
      .eye = Vec3(0.1, -0.3, 0.2), .target = Vec3(0.02, 0, 0.01), .field_of_view = 0.7};
  const View view = make_view(camera, 640, 480);
  for (const Vec3& x : {Vec3(0, 0, 0), Vec3(0.05, 0.02, -0.03), Vec3(-0.07, 0.1, 0.04)}) {
    const Eigen::Vector4d clip = view.projection.cast<double>() * x.homogeneous();
    const Vec2 pixel = project(view, x, 640, 480);
    EXPECT_NEAR(pixel.x(), 320 * (1 + clip.x() / clip.w()),
                1e-3);  // 640 pixels in single precision
    EXPECT_NEAR(pixel.y(), 240 * (1 - clip.y() / clip.w()), 1e-3);
    EXPECT_GT(clip.z(), -clip.w());
    EXPECT_LT(clip.z(), clip.w());
  }
}

TEST(View, target_is_in_the_middle_and_the_field_of_view_ends_at_the_border) {
  const Camera camera{
      .eye = Vec3(0, 0, 2), .target = Vec3::Zero(), .up = Vec3::UnitY(), .field_of_view = 1.0};
  const View view = make_view(camera, 200, 100);
  EXPECT_NEAR((project(view, camera.target, 200, 100) - Vec2(100, 50)).norm(), 0, 1e-12);
  const double edge = 2 * std::tan(0.5);
  EXPECT_NEAR(project(view, Vec3(0, edge, 0), 200, 100).y(), 0, 1e-9);
  EXPECT_NEAR(project(view, Vec3(2 * edge, 0, 0), 200, 100).x(), 200, 1e-9);
}

TEST(View, looking_along_the_up_direction_still_has_a_right_handed_frame) {
  const Camera camera{.eye = Vec3(0, 0, 1), .target = Vec3::Zero(), .up = Vec3::UnitZ()};
  const View view = make_view(camera, 10, 10);
  EXPECT_NEAR(view.right.cross(view.up).dot(-view.forward), 1, 1e-12);
}

TEST(View, lamps_map_sees_what_the_picture_shows_near_the_target) {
  const Camera camera{
      .eye = Vec3(0, 0, 1), .target = Vec3::Zero(), .up = Vec3::UnitY(), .field_of_view = 0.8};
  const View view = make_view(camera, 160, 90);
  const double y = std::tan(0.4), x = y * 160 / 90;
  for (const Vec3& corner : {Vec3(x, y, 0), Vec3(-x, y, 0), Vec3(x, -y, 0)}) {
    const Eigen::Vector4d clip = view.lamp_projection.cast<double>() * corner.homogeneous();
    EXPECT_LT(std::abs(clip.x()), clip.w());
    EXPECT_LT(std::abs(clip.y()), clip.w());
  }
}
