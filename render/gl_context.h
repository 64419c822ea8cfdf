// An off-screen OpenGL 3.3 core context of OSMesa. The library is found at run time (dlopen), so
// that a scene without a camera never loads it; all of OpenGL is called through the pointers held
// here.
#pragma once

#include <GL/glcorearb.h>

#include <memory>
#include <span>
#include <string>

namespace trocar {

// The functions that the renderer calls, without their prefix "gl".
struct GlFunctions {
  PFNGLACTIVETEXTUREPROC ActiveTexture;
  PFNGLATTACHSHADERPROC AttachShader;
  PFNGLBINDATTRIBLOCATIONPROC BindAttribLocation;
  PFNGLBINDBUFFERPROC BindBuffer;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer;
  PFNGLBINDTEXTUREPROC BindTexture;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray;
  PFNGLBLITFRAMEBUFFERPROC BlitFramebuffer;
  PFNGLBUFFERDATAPROC BufferData;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus;
  PFNGLCLEARPROC Clear;
  PFNGLCLEARCOLORPROC ClearColor;
  PFNGLCOMPILESHADERPROC CompileShader;
  PFNGLCREATEPROGRAMPROC CreateProgram;
  PFNGLCREATESHADERPROC CreateShader;
  PFNGLDELETESHADERPROC DeleteShader;
  PFNGLDEPTHFUNCPROC DepthFunc;
  PFNGLDISABLEPROC Disable;
  PFNGLDRAWARRAYSPROC DrawArrays;
  PFNGLDRAWBUFFERPROC DrawBuffer;
  PFNGLDRAWELEMENTSPROC DrawElements;
  PFNGLENABLEPROC Enable;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray;
  PFNGLFINISHPROC Finish;
  PFNGLFRAMEBUFFERTEXTURE2DPROC FramebufferTexture2D;
  PFNGLGENBUFFERSPROC GenBuffers;
  PFNGLGENERATEMIPMAPPROC GenerateMipmap;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers;
  PFNGLGENTEXTURESPROC GenTextures;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays;
  PFNGLGETERRORPROC GetError;
  PFNGLGETPROGRAMINFOLOGPROC GetProgramInfoLog;
  PFNGLGETPROGRAMIVPROC GetProgramiv;
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog;
  PFNGLGETSHADERIVPROC GetShaderiv;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation;
  PFNGLLINKPROGRAMPROC LinkProgram;
  PFNGLPIXELSTOREIPROC PixelStorei;
  PFNGLPOLYGONOFFSETPROC PolygonOffset;
  PFNGLREADBUFFERPROC ReadBuffer;
  PFNGLREADPIXELSPROC ReadPixels;
  PFNGLSCISSORPROC Scissor;
  PFNGLSHADERSOURCEPROC ShaderSource;
  PFNGLTEXIMAGE2DPROC TexImage2D;
  PFNGLTEXIMAGE2DMULTISAMPLEPROC TexImage2DMultisample;
  PFNGLTEXIMAGE3DPROC TexImage3D;
  PFNGLTEXPARAMETERIPROC TexParameteri;
  PFNGLUNIFORM1FPROC Uniform1f;
  PFNGLUNIFORM1IPROC Uniform1i;
  PFNGLUNIFORM2FPROC Uniform2f;
  PFNGLUNIFORM3FPROC Uniform3f;
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv;
  PFNGLUSEPROGRAMPROC UseProgram;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer;
  PFNGLVIEWPORTPROC Viewport;
};

// Handle of the first library of `names` that can be loaded; it stays loaded until the process ends
// (Mesa's threads and exit handlers do not survive an unload). Throws MachineError naming the
// package.
void* load_osmesa(std::span<const char* const> names);

class GlContext {
 public:
  // Throws MachineError. The context is current in no thread.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const GlFunctions& gl() const { return gl_; }
  // Throws MachineError "while <doing>: …" if OpenGL reported an error since the last call.
  void check(const std::string& doing) const;

 private:
  friend class GlCurrent;
  struct Osmesa;
  std::unique_ptr<Osmesa> osmesa_;
  GlFunctions gl_{};
};

// Makes a context current in the calling thread for the life of this object.
class GlCurrent {
 public:
  explicit GlCurrent(const GlContext& context);
  ~GlCurrent();
  GlCurrent(const GlCurrent&) = delete;
  GlCurrent& operator=(const GlCurrent&) = delete;

 private:
  const GlContext& context_;
};

}  // namespace trocar
