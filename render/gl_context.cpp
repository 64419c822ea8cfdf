#include "render/gl_context.h"

// osmesa.h after glcorearb.h: only its types are used.
#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <cstdlib>

#include "base/error.h"

namespace trocar {

namespace {

constexpr std::array<const char*, 3> library_names = {"libOSMesa.so.8", "libOSMesa.so.6",
                                                      "libOSMesa.so"};
// The pictures are drawn into framebuffer objects; the buffer that OSMesa asks for stays unused.
constexpr int unused_side = 4;

constexpr std::array<int, 11> context_attributes = {OSMESA_FORMAT,
                                                    OSMESA_RGBA,
                                                    OSMESA_PROFILE,
                                                    OSMESA_CORE_PROFILE,
                                                    OSMESA_CONTEXT_MAJOR_VERSION,
                                                    3,
                                                    OSMESA_CONTEXT_MINOR_VERSION,
                                                    3,
                                                    OSMESA_DEPTH_BITS,
                                                    0,
                                                    0};

template <class Function>
Function library_symbol(void* library, const char* name) {
  void* symbol = dlsym(library, name);
  if (!symbol)
    throw MachineError(std::string("libOSMesa has no function ") + name +
                       "; Mesa 12 or newer is needed (Debian package libosmesa6)");
  return reinterpret_cast<Function>(symbol);
}

}  // namespace

void* load_osmesa(std::span<const char* const> names) {
  std::string reason = "no name to look for";
  for (const char* name : names) {
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
    if (const char* error = dlerror()) reason = error;
  }
  throw MachineError("pictures need the off-screen OpenGL library OSMesa, which can't be loaded (" +
                     reason + "); install the package libosmesa6");
}

struct GlContext::Osmesa {
  decltype(&OSMesaCreateContextAttribs) create;
  decltype(&OSMesaDestroyContext) destroy;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaGetProcAddress) get_proc_address;
  OSMesaContext context = nullptr;
  std::array<std::uint8_t, std::size_t{4} * unused_side * unused_side> unused_pixels{};

  explicit Osmesa(void* library)
      : create(library_symbol<decltype(create)>(library, "OSMesaCreateContextAttribs")),
        destroy(library_symbol<decltype(destroy)>(library, "OSMesaDestroyContext")),
        make_current(library_symbol<decltype(make_current)>(library, "OSMesaMakeCurrent")),
        get_proc_address(
            library_symbol<decltype(get_proc_address)>(library, "OSMesaGetProcAddress")) {
    context = create(context_attributes.data(), nullptr);
    if (!context)
      throw MachineError(
          "OSMesa can't create an OpenGL 3.3 core context; a Mesa with the llvmpipe driver is "
          "needed (Debian package libosmesa6)");
  }
  ~Osmesa() { destroy(context); }
  Osmesa(const Osmesa&) = delete;
  Osmesa& operator=(const Osmesa&) = delete;

  template <class Function>
  void find(Function& function, const char* name) const {
    function = reinterpret_cast<Function>(get_proc_address(name));
    if (!function)
      throw MachineError(std::string("this OSMesa lacks the OpenGL 3.3 function ") + name);
  }
};

namespace {

template <class Osmesa>
void find_drawing(const Osmesa& o, GlFunctions& gl) {
  o.find(gl.BindFramebuffer, "glBindFramebuffer");
  o.find(gl.BlitFramebuffer, "glBlitFramebuffer");
  o.find(gl.CheckFramebufferStatus, "glCheckFramebufferStatus");
  o.find(gl.Clear, "glClear");
  o.find(gl.ClearColor, "glClearColor");
  o.find(gl.DepthFunc, "glDepthFunc");
  o.find(gl.Disable, "glDisable");
  o.find(gl.DrawArrays, "glDrawArrays");
  o.find(gl.DrawBuffer, "glDrawBuffer");
  o.find(gl.DrawElements, "glDrawElements");
  o.find(gl.Enable, "glEnable");
  o.find(gl.Finish, "glFinish");
  o.find(gl.FramebufferTexture2D, "glFramebufferTexture2D");
  o.find(gl.GenFramebuffers, "glGenFramebuffers");
  o.find(gl.GetError, "glGetError");
  o.find(gl.PixelStorei, "glPixelStorei");
  o.find(gl.PolygonOffset, "glPolygonOffset");
  o.find(gl.ReadBuffer, "glReadBuffer");
  o.find(gl.ReadPixels, "glReadPixels");
  o.find(gl.Scissor, "glScissor");
  o.find(gl.Viewport, "glViewport");
}

template <class Osmesa>
void find_shading(const Osmesa& o, GlFunctions& gl) {
  o.find(gl.AttachShader, "glAttachShader");
  o.find(gl.BindAttribLocation, "glBindAttribLocation");
  o.find(gl.CompileShader, "glCompileShader");
  o.find(gl.CreateProgram, "glCreateProgram");
  o.find(gl.CreateShader, "glCreateShader");
  o.find(gl.DeleteShader, "glDeleteShader");
  o.find(gl.GetProgramInfoLog, "glGetProgramInfoLog");
  o.find(gl.GetProgramiv, "glGetProgramiv");
  o.find(gl.GetShaderInfoLog, "glGetShaderInfoLog");
  o.find(gl.GetShaderiv, "glGetShaderiv");
  o.find(gl.GetUniformLocation, "glGetUniformLocation");
  o.find(gl.LinkProgram, "glLinkProgram");
  o.find(gl.ShaderSource, "glShaderSource");
  o.find(gl.Uniform1f, "glUniform1f");
  o.find(gl.Uniform1i, "glUniform1i");
  o.find(gl.Uniform2f, "glUniform2f");
  o.find(gl.Uniform3f, "glUniform3f");
  o.find(gl.UniformMatrix4fv, "glUniformMatrix4fv");
  o.find(gl.UseProgram, "glUseProgram");
}

template <class Osmesa>
void find_storage(const Osmesa& o, GlFunctions& gl) {
  o.find(gl.ActiveTexture, "glActiveTexture");
  o.find(gl.BindBuffer, "glBindBuffer");
  o.find(gl.BindTexture, "glBindTexture");
  o.find(gl.BindVertexArray, "glBindVertexArray");
  o.find(gl.BufferData, "glBufferData");
  o.find(gl.EnableVertexAttribArray, "glEnableVertexAttribArray");
  o.find(gl.GenBuffers, "glGenBuffers");
  o.find(gl.GenerateMipmap, "glGenerateMipmap");
  o.find(gl.GenTextures, "glGenTextures");
  o.find(gl.GenVertexArrays, "glGenVertexArrays");
  o.find(gl.TexImage2D, "glTexImage2D");
  o.find(gl.TexImage2DMultisample, "glTexImage2DMultisample");
  o.find(gl.TexImage3D, "glTexImage3D");
  o.find(gl.TexParameteri, "glTexParameteri");
  o.find(gl.VertexAttribPointer, "glVertexAttribPointer");
}

}  // namespace

GlContext::GlContext() {
  // llvmpipe would start a thread per core; one picture is drawn beside the simulation by the
  // thread that asks for it. A value that the user set stays.
  setenv("LP_NUM_THREADS", "0", 0);
  osmesa_ = std::make_unique<Osmesa>(load_osmesa(library_names));
  find_drawing(*osmesa_, gl_);
  find_shading(*osmesa_, gl_);
  find_storage(*osmesa_, gl_);
}

GlContext::~GlContext() = default;

void GlContext::check(const std::string& doing) const {
  const GLenum error = gl_.GetError();
  if (error == GL_NO_ERROR) return;
  const std::string reason = error == GL_OUT_OF_MEMORY ? "out of memory, try a smaller picture"
                                                       : "OpenGL error " + std::to_string(error);
  throw MachineError("while " + doing + ": " + reason);
}

GlCurrent::GlCurrent(const GlContext& context) : context_(context) {
  GlContext::Osmesa& o = *context_.osmesa_;
  if (!o.make_current(o.context, o.unused_pixels.data(), GL_UNSIGNED_BYTE, unused_side,
                      unused_side))
    throw MachineError("OSMesa can't make its context current in this thread");
}

GlCurrent::~GlCurrent() {
  context_.osmesa_->make_current(nullptr, nullptr, 0, 0, 0);
}

}  // namespace trocar
