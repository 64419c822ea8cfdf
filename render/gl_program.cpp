#include "render/gl_program.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "render/gl_mesh.h"

namespace trocar {

namespace {

constexpr int log_length = 2000;

GLuint compile(const GlFunctions& gl, GLenum kind, const std::string& name,
               const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint is_compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
  if (is_compiled) return shader;
  std::array<char, log_length> log{};
  gl.GetShaderInfoLog(shader, log_length, nullptr, log.data());
  throw MachineError("this OSMesa can't compile the shader '" + name + "': " + log.data());
}

void set_lookup(const GlFunctions& gl, GLenum filter) {
  const GLint f = static_cast<GLint>(filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, f);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, f);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GLuint make_plane(const GlFunctions& gl, const GlTarget& size, GLenum format,
                  const GlTargetFormat& wanted) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  if (wanted.samples > 0) {
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
    gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, wanted.samples, format, size.width,
                             size.height, GL_TRUE);
    return texture;
  }
  const bool is_depth = format == GL_DEPTH_COMPONENT24;
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), size.width, size.height, 0,
                is_depth ? GL_DEPTH_COMPONENT : GL_RGBA,
                is_depth ? GL_UNSIGNED_INT : GL_UNSIGNED_BYTE, nullptr);
  set_lookup(gl, wanted.is_filtered ? GL_LINEAR : GL_NEAREST);
  if (is_depth && wanted.is_shadow_map) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  }
  return texture;
}

}  // namespace

GlProgram make_program(const GlContext& context, const std::string& name, const std::string& vertex,
                       const std::string& fragment) {
  const GlFunctions& gl = context.gl();
  const GLuint program = gl.CreateProgram();
  for (const auto& [kind, source] :
       {std::pair{GL_VERTEX_SHADER, &vertex}, std::pair{GL_FRAGMENT_SHADER, &fragment}}) {
    const GLuint shader = compile(gl, static_cast<GLenum>(kind), name, *source);
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  for (std::size_t k = 0; k < gl_attribute_names.size(); ++k)
    gl.BindAttribLocation(program, static_cast<GLuint>(k), gl_attribute_names[k]);
  gl.LinkProgram(program);
  GLint is_linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &is_linked);
  if (is_linked) return {.gl = &gl, .id = program};
  std::array<char, log_length> log{};
  gl.GetProgramInfoLog(program, log_length, nullptr, log.data());
  throw MachineError("this OSMesa can't link the shader '" + name + "': " + log.data());
}

GlTarget make_target(const GlContext& context, int width, int height,
                     const GlTargetFormat& format) {
  const GlFunctions& gl = context.gl();
  GlTarget target{.width = width, .height = height};
  gl.GenFramebuffers(1, &target.framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  const GLenum kind = format.samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  if (format.colour != 0) {
    target.colour = make_plane(gl, target, format.colour, format);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, kind, target.colour, 0);
  } else {
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
  }
  if (format.has_depth) {
    target.depth = make_plane(gl, target, GL_DEPTH_COMPONENT24, format);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, kind, target.depth, 0);
  }
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  context.check("making a drawing surface of " + size + " pixels");
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw MachineError("this OSMesa can't draw into a surface of " + size +
                       " pixels; try a smaller picture");
  return target;
}

void bind_target(const GlFunctions& gl, const GlTarget& target) {
  gl.Disable(GL_SCISSOR_TEST);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl.Viewport(0, 0, target.width, target.height);
}

void bind_middle(const GlFunctions& gl, const GlTarget& target, double part) {
  bind_target(gl, target);
  const int left = std::max(0, static_cast<int>(0.5 * (1 - part) * target.width));
  gl.Enable(GL_SCISSOR_TEST);
  gl.Scissor(left, 0, target.width - 2 * left, target.height);
}

void bind_texture(const GlFunctions& gl, int unit, GLenum kind, GLuint texture) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(kind, texture);
}

}  // namespace trocar
