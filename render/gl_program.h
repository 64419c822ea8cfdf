// Shader programs, textures and framebuffers. The objects live as long as the context that they
// were made in.
#pragma once

#include <string>

#include "base/vec.h"
#include "render/gl_context.h"

namespace trocar {

using Mat4f = Eigen::Matrix4f;

// Vertex attributes have the same numbers in all programs (gl_mesh.h).
struct GlProgram {
  const GlFunctions* gl = nullptr;
  GLuint id = 0;

  void use() const { gl->UseProgram(id); }
  // Uniforms of the program in use; a name that the compiler dropped is no error.
  void set(const char* name, int value) const { gl->Uniform1i(at(name), value); }
  void set(const char* name, double value) const {
    gl->Uniform1f(at(name), static_cast<float>(value));
  }
  void set(const char* name, double a, double b) const {
    gl->Uniform2f(at(name), static_cast<float>(a), static_cast<float>(b));
  }
  void set(const char* name, const Vec3& v) const {
    const Eigen::Vector3f f = v.cast<float>();
    gl->Uniform3f(at(name), f.x(), f.y(), f.z());
  }
  void set(const char* name, const Mat4f& m) const {
    gl->UniformMatrix4fv(at(name), 1, GL_FALSE, m.data());
  }

 private:
  GLint at(const char* name) const { return gl->GetUniformLocation(id, name); }
};

// Throws MachineError with the compiler's log. `name` is for that message.
GlProgram make_program(const GlContext& context, const std::string& name, const std::string& vertex,
                       const std::string& fragment);

// A colour and / or a depth texture to draw into; 0 where there is none.
struct GlTarget {
  GLuint framebuffer = 0, colour = 0, depth = 0;
  int width = 0, height = 0;
};

struct GlTargetFormat {
  GLenum colour = 0;  // GL_RGBA8 …, 0: no colour
  bool has_depth = false;
  int samples = 0;             // 0: a plain texture
  bool is_filtered = false;    // linear lookup
  bool is_shadow_map = false;  // the depth is looked up by comparison
};

// Throws MachineError if there is too little memory.
GlTarget make_target(const GlContext& context, int width, int height, const GlTargetFormat& format);
// Draws into the whole of it from now on.
void bind_target(const GlFunctions& gl, const GlTarget& target);
// … but only into its middle columns, this part of the width.
void bind_middle(const GlFunctions& gl, const GlTarget& target, double part);
void bind_texture(const GlFunctions& gl, int unit, GLenum kind, GLuint texture);

}  // namespace trocar
