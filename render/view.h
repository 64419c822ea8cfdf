// What the shaders need to know of a camera: projection, and the lamp at the tip of the endoscope.
#pragma once

#include "render/renderer.h"

namespace trocar {

struct View {
  Eigen::Matrix4f projection;       // world to clip space of the picture
  Eigen::Matrix4f lamp_projection;  // world to clip space of the lamp's shadow map
  Vec3 eye, lamp;                   // [m]
  Vec3 right, up, forward;          // unit, of the picture
  double distance = 1;              // from the eye to what it looks at [m]
  double tan_half_height = 1;       // of the field of view
  double aspect = 1;
  double near = 0, far = 1;  // [m]
  double visible_part = 1;   // of the width, in the middle: what the endoscope's mask leaves
};

// Radius of the endoscope's round picture, in half heights.
inline constexpr double mask_radius = 1.225;

// A camera that can't be drawn from (eye on target, not finite, field of view outside 0.01…3)
// throws InputError.
View make_view(const Camera& camera, int width, int height);

// Pixel (x to the right, y down, pixel centres at .5) of a point in front of the camera.
Vec2 project(const View& view, const Vec3& x, int width, int height);

}  // namespace trocar
