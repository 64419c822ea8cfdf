#include "render/gl_post.h"

#include <algorithm>

#include "render/gl_light.h"
#include "render/shader_post.h"
#include "render/shader_screen.h"
#include "render/shader_shade.h"

namespace trocar {

namespace {

// Creases darken within this part of the distance to the target.
constexpr double occlusion_reach = 0.055;
constexpr GLenum wide_format = GL_RGBA16F;

GlTarget part_of(const GlContext& context, int width, int height, int divisor, GLenum format) {
  return make_target(context, std::max(1, width / divisor), std::max(1, height / divisor),
                     {.colour = format, .is_filtered = true});
}

}  // namespace

GlPost::GlPost(const GlContext& context, int width, int height)
    : gl_(context.gl()),
      shade_program_(make_program(context, "shade", shader_screen_vertex, shader_shade)),
      blur_program_(make_program(context, "shade blur", shader_screen_vertex, shader_shade_blur)),
      glow_program_(make_program(context, "glow", shader_screen_vertex, shader_glow)),
      composite_program_(
          make_program(context, "composite", shader_screen_vertex, shader_composite)),
      shade_(part_of(context, width, height, 2, wide_format)),
      blurred_(part_of(context, width, height, 2, wide_format)),
      glow_x_(part_of(context, width, height, 4, wide_format)),
      glow_(part_of(context, width, height, 4, wide_format)),
      output_(part_of(context, width, height, 1, GL_RGBA8)) {
  gl_.GenVertexArrays(1, &no_vertices_);
}

void GlPost::fill_screen() const {
  gl_.BindVertexArray(no_vertices_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.BindVertexArray(0);
}

void GlPost::find_shade(GLuint depth, GLuint shadow_map, const View& view) const {
  gl_.Disable(GL_DEPTH_TEST);
  bind_target(gl_, shade_);
  gl_.Clear(GL_COLOR_BUFFER_BIT);  // the blur looks beyond the middle
  bind_middle(gl_, shade_, view.visible_part);
  bind_texture(gl_, 0, GL_TEXTURE_2D, depth);
  bind_texture(gl_, 1, GL_TEXTURE_2D, shadow_map);
  use_with_view(shade_program_, view);
  shade_program_.set("depth_map", 0);
  shade_program_.set("shadow_map", 1);
  shade_program_.set("reach", occlusion_reach * view.distance);
  fill_screen();

  bind_middle(gl_, blurred_, view.visible_part);
  bind_texture(gl_, 0, GL_TEXTURE_2D, shade_.colour);
  blur_program_.use();
  blur_program_.set("shade", 0);
  fill_screen();
  gl_.Enable(GL_DEPTH_TEST);
}

void GlPost::find_glow(const GlTarget& picture) const {
  glow_program_.use();
  glow_program_.set("picture", 0);
  glow_program_.set("is_first", 1.0);
  glow_program_.set("spacing", 1.0 / glow_.width, 0.0);
  bind_target(gl_, glow_x_);
  bind_texture(gl_, 0, GL_TEXTURE_2D, picture.colour);
  fill_screen();
  glow_program_.set("is_first", 0.0);
  glow_program_.set("spacing", 0.0, 1.0 / glow_.height);
  bind_target(gl_, glow_);
  bind_texture(gl_, 0, GL_TEXTURE_2D, glow_x_.colour);
  fill_screen();
}

void GlPost::run(const GlTarget& picture, const View& view, bool has_endoscope_mask) const {
  gl_.Disable(GL_DEPTH_TEST);
  find_glow(picture);

  bind_target(gl_, output_);
  gl_.ClearColor(0, 0, 0, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  bind_middle(gl_, output_, view.visible_part);
  bind_texture(gl_, 0, GL_TEXTURE_2D, picture.colour);
  bind_texture(gl_, 1, GL_TEXTURE_2D, blurred_.colour);
  bind_texture(gl_, 2, GL_TEXTURE_2D, glow_.colour);
  composite_program_.use();
  composite_program_.set("picture", 0);
  composite_program_.set("shade", 1);
  composite_program_.set("glow", 2);
  composite_program_.set("aspect", view.aspect);
  composite_program_.set("is_endoscope", has_endoscope_mask ? 1.0 : 0.0);
  composite_program_.set("mask_radius", mask_radius);
  fill_screen();
}

}  // namespace trocar
