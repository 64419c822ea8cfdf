#include "render/gl_post.h"

#include <algorithm>

#include "render/shader_instrument.h"
#include "render/shader_post.h"

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
      occlusion_program_(
          make_program(context, "occlusion", shader_screen_vertex, shader_occlusion)),
      blur_program_(
          make_program(context, "occlusion blur", shader_screen_vertex, shader_occlusion_blur)),
      glow_program_(make_program(context, "glow", shader_screen_vertex, shader_glow)),
      composite_program_(
          make_program(context, "composite", shader_screen_vertex, shader_composite)),
      occlusion_(part_of(context, width, height, 2, wide_format)),
      blurred_(part_of(context, width, height, 2, GL_RGBA8)),
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

void GlPost::find_occlusion(const GlTarget& picture, const View& view) const {
  bind_middle(gl_, occlusion_, view.visible_part);
  bind_texture(gl_, 0, GL_TEXTURE_2D, picture.depth);
  occlusion_program_.use();
  occlusion_program_.set("depth", 0.0);
  occlusion_program_.set("depth_map", 0);
  occlusion_program_.set("tan_half", view.tan_half_height * view.aspect, view.tan_half_height);
  occlusion_program_.set("near_far", view.near, view.far);
  occlusion_program_.set("reach", occlusion_reach * view.distance);
  fill_screen();

  bind_middle(gl_, blurred_, view.visible_part);
  bind_texture(gl_, 0, GL_TEXTURE_2D, occlusion_.colour);
  blur_program_.use();
  blur_program_.set("depth", 0.0);
  blur_program_.set("occlusion", 0);
  fill_screen();
}

void GlPost::find_glow(const GlTarget& picture) const {
  glow_program_.use();
  glow_program_.set("depth", 0.0);
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
  find_occlusion(picture, view);
  find_glow(picture);

  bind_target(gl_, output_);
  gl_.ClearColor(0, 0, 0, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  bind_middle(gl_, output_, view.visible_part);
  bind_texture(gl_, 0, GL_TEXTURE_2D, picture.colour);
  bind_texture(gl_, 1, GL_TEXTURE_2D, blurred_.colour);
  bind_texture(gl_, 2, GL_TEXTURE_2D, glow_.colour);
  composite_program_.use();
  composite_program_.set("depth", 0.0);
  composite_program_.set("picture", 0);
  composite_program_.set("occlusion", 1);
  composite_program_.set("glow", 2);
  composite_program_.set("aspect", view.aspect);
  composite_program_.set("is_endoscope", has_endoscope_mask ? 1.0 : 0.0);
  composite_program_.set("mask_radius", mask_radius);
  fill_screen();
}

}  // namespace trocar
