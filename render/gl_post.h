// The passes over the whole picture: creases and shadow, highlights glowing, tone curve, sRGB, the
// endoscope's mask.
#pragma once

#include "render/gl_program.h"
#include "render/view.h"

namespace trocar {

class GlPost {
 public:
  GlPost(const GlContext& context, int width, int height);
  // From the depths of the picture and of the lamp's shadow map, before surfaces are drawn.
  void find_shade(GLuint depth, GLuint shadow_map, const View& view) const;
  // r: openness, g: lit part, b: depth; at half the picture's size.
  GLuint shade() const { return blurred_.colour; }
  // From a picture (compressed radiance and depth, shader_light.h) to 8-bit sRGB with rows top-down
  // in output().
  void run(const GlTarget& picture, const View& view, bool has_endoscope_mask) const;
  const GlTarget& output() const { return output_; }
  // A triangle over the whole target, with shader_screen_vertex.
  void fill_screen() const;

 private:
  void find_glow(const GlTarget& picture) const;

  const GlFunctions& gl_;
  GlProgram shade_program_, blur_program_, glow_program_, composite_program_;
  GlTarget shade_, blurred_, glow_x_, glow_, output_;
  GLuint no_vertices_ = 0;
};

}  // namespace trocar
