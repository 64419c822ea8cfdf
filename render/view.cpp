#include "render/view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace trocar {

namespace {

// Of the distance to the target: the depth buffer resolves 3e-6 of it there.
constexpr double near_part = 0.02, far_part = 30;
constexpr double lamp_right = 0.30, lamp_up = 0.22;  // of the same distance

constexpr double mask_margin = 0.06;

using Mat4 = Eigen::Matrix4d;

Mat4 look_along(const Vec3& eye, const Vec3& right, const Vec3& up, const Vec3& forward) {
  Mat4 m = Mat4::Identity();
  m.block<1, 3>(0, 0) = right.transpose();
  m.block<1, 3>(1, 0) = up.transpose();
  m.block<1, 3>(2, 0) = -forward.transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye;
  return m;
}

Mat4 perspective(double tan_half_height, double aspect, double near, double far) {
  Mat4 m = Mat4::Zero();
  m(0, 0) = 1 / (tan_half_height * aspect);
  m(1, 1) = 1 / tan_half_height;
  m(2, 2) = -(far + near) / (far - near);
  m(2, 3) = -2 * far * near / (far - near);
  m(3, 2) = -1;
  return m;
}

// Unit vector across `forward`, as near to `wish` as can be.
Vec3 upright(const Vec3& forward, const Vec3& wish) {
  const Vec3 across = wish - wish.dot(forward) * forward;
  if (across.norm() > 1e-6 * wish.norm()) return across.normalized();
  return forward.unitOrthogonal();  // looks along its up direction: any will do
}

void check_camera(const Camera& camera) {
  const bool is_finite =
      camera.eye.allFinite() && camera.target.allFinite() && camera.up.allFinite();
  if (!is_finite) throw InputError("a camera's eye, target and up direction must be finite");
  if (!(camera.eye - camera.target).allFinite() || (camera.eye - camera.target).norm() < 1e-9)
    throw InputError("a camera's eye and target must be different points");
  if (!(camera.field_of_view >= 0.01 && camera.field_of_view <= 3))
    throw InputError("a camera's field of view must be 0.01 to 3 rad, not " +
                     std::to_string(camera.field_of_view));
}

}  // namespace

View make_view(const Camera& camera, int width, int height) {
  check_camera(camera);
  View view;
  view.eye = camera.eye;
  view.distance = (camera.target - camera.eye).norm();
  view.forward = (camera.target - camera.eye) / view.distance;
  view.up = upright(view.forward, camera.up);
  view.right = view.forward.cross(view.up);
  view.tan_half_height = std::tan(0.5 * camera.field_of_view);
  view.aspect = static_cast<double>(width) / height;
  // A little more than the circle: the blurs look beside their pixels.
  if (camera.has_endoscope_mask)
    view.visible_part = std::min(1.0, (mask_radius + mask_margin) / view.aspect);
  view.near = near_part * view.distance;
  view.far = far_part * view.distance;
  view.projection = (perspective(view.tan_half_height, view.aspect, view.near, view.far) *
                     look_along(view.eye, view.right, view.up, view.forward))
                        .cast<float>();

  view.lamp = view.eye + view.distance * (lamp_right * view.right + lamp_up * view.up);
  const Vec3 beam = (camera.target - view.lamp).normalized();
  const Vec3 lamp_top = upright(beam, view.up);
  const double spread = 1.1 * view.tan_half_height * std::sqrt(1 + view.aspect * view.aspect);
  view.lamp_projection = (perspective(spread, 1, view.near, view.far) *
                          look_along(view.lamp, beam.cross(lamp_top), lamp_top, beam))
                             .cast<float>();
  return view;
}

Vec2 project(const View& view, const Vec3& x, int width, int height) {
  const Vec3 d = x - view.eye;
  const double depth = d.dot(view.forward);
  const double right = d.dot(view.right) / (depth * view.tan_half_height * view.aspect);
  const double up = d.dot(view.up) / (depth * view.tan_half_height);
  return {0.5 * width * (1 + right), 0.5 * height * (1 - up)};
}

}  // namespace trocar
