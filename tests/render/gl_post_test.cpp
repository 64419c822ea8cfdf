#include "render/gl_post.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace trocar;

namespace {

double filmic(double c) {
  return std::min(1.0, c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14));
}
double srgb(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

}  // namespace

TEST(GlPost, known_radiance_leaves_as_its_tone_in_srgb) {
  const GlContext context;
  const GlCurrent current(context);
  const GlFunctions& gl = context.gl();
  const int w = 64, h = 48;
  const GlPost post(context, w, h);
  const GlTarget picture =
      make_target(context, w, h, {.colour = GL_RGBA16F, .has_depth = true, .is_filtered = true});
  const GlTarget shadow =
      make_target(context, 16, 16, {.has_depth = true, .is_filtered = true, .is_shadow_map = true});
  const View view = make_view({}, w, h);
  for (const Vec3& radiance :
       {Vec3(0.02, 0.001, 0.0), Vec3(0.5, 0.18, 0.06), Vec3(0.85, 0.4, 0.7)}) {
    bind_target(gl, picture);
    const Eigen::Vector3f c =
        (radiance / (1 + radiance.maxCoeff())).cast<float>();  // as surfaces write it
    gl.ClearColor(c.x(), c.y(), c.z(), 1);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    post.find_shade(picture.depth, shadow.depth, view);  // nothing near: nothing darkens
    post.run(picture, view, false);
    std::array<std::uint8_t, 4> pixel{};
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, post.output().framebuffer);
    gl.ReadPixels(w / 2, h / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    // Half a level of dither, half of rounding, half for half-precision floats.
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(pixel[k], 255 * srgb(filmic(radiance[k])), 1.5) << k;
  }
  EXPECT_EQ(gl.GetError(), static_cast<GLenum>(GL_NO_ERROR));
}
