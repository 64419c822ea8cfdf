// The passes over the whole picture: creases darkened, highlights glowing, tone curve, sRGB, the
// endoscope's mask.
#pragma once

#include "render/gl_program.h"
#include "render/view.h"

namespace trocar {

class GlPost {
 public:
  GlPost(const GlContext& context, int width, int height);
  // From a picture (compressed radiance and depth, shader_light.h) to 8-bit sRGB with rows top-down
  // in output().
  void run(const GlTarget& picture, const View& view, bool has_endoscope_mask) const;
  const GlTarget& output() const { return output_; }
  // A triangle over the whole target, with shader_screen_vertex.
  void fill_screen() const;

 private:
  void find_occlusion(const GlTarget& picture, const View& view) const;
  void find_glow(const GlTarget& picture) const;

  const GlFunctions& gl_;
  GlProgram occlusion_program_, blur_program_, glow_program_, composite_program_;
  GlTarget occlusion_, blurred_, glow_x_, glow_, output_;
  GLuint no_vertices_ = 0;
};

}  // namespace trocar
