#include <algorithm>
#include <optional>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "base/timers.h"
#include "render/caption.h"
#include "render/gl_light.h"
#include "render/gl_mesh.h"
#include "render/gl_post.h"
#include "render/renderer.h"
#include "render/shader_instrument.h"
#include "render/shader_screen.h"
#include "render/shader_surface.h"
#include "render/shader_tissue.h"
#include "render/surface_mesh.h"
#include "render/tissue_pattern.h"
#include "render/view.h"

namespace trocar {

namespace {

constexpr int largest_side = 8192;
constexpr int n_samples = 4;  // llvmpipe offers no more
constexpr GLenum picture_format = GL_RGBA16F;
constexpr int shadow_side = 1024;
constexpr int cavity_divisor = 4;  // of the sides: the wall is out of focus
constexpr int pattern_side = 64, pattern_cells = 8;
// Names of PhaseTimers, in the order of their indices.
constexpr const char* phase_names[] = {"normals",  "upload", "shade",
                                       "surfaces", "post",   "read back"};
enum Phase : std::size_t {
  normals_phase,
  upload_phase,
  shade_phase,
  surfaces_phase,
  post_phase,
  read_back_phase
};
constexpr double tool_crease_cosine = 0.82;  // 35 degrees
// Surfaces up to this size are refined: finer ones look round as they are.
constexpr std::size_t most_refined_triangles = 20000;

GLuint make_solid_texture(const GlContext& context, int side,
                          const std::vector<std::uint8_t>& rgba) {
  const GlFunctions& gl = context.gl();
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_3D, texture);
  gl.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, side, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                rgba.data());
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.GenerateMipmap(GL_TEXTURE_3D);
  context.check("making the tissue pattern");
  return texture;
}

int checked_side(int side, int width, int height) {
  if (side >= 1 && side <= largest_side) return side;
  throw InputError("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels can't be drawn; width and height must be 1 to " +
                   std::to_string(largest_side));
}

SurfaceMesh tissue_mesh(const TissueView& tissue, const Vec3& eye) {
  std::vector<Vec3> colour;
  colour.reserve(tissue.triangle.size());
  for (std::size_t t = 0; t < tissue.triangle.size(); ++t) {
    const TissueColours& of = tissue.look.colours[tissue.region.empty() ? 0 : tissue.region[t]];
    colour.push_back(!tissue.is_cut.empty() && tissue.is_cut[t] != 0 ? of.cut : of.outer);
  }
  const SurfaceMesh mesh = make_surface_mesh({.x = tissue.x,
                                              .X = tissue.X,
                                              .triangle = tissue.triangle,
                                              .is_cut = tissue.is_cut,
                                              .colour = colour});
  if (tissue.has_edges) return mark_edges(mesh, tissue.is_quad_half);
  if (mesh.index.size() > 3 * most_refined_triangles || tissue.is_two_sided) return mesh;
  return refine_surface_mesh(mesh, &eye);
}

// In the world; X stays in the instrument's frame, where the brush marks are.
SurfaceMesh instrument_mesh(const InstrumentView& instrument) {
  std::vector<Vec3> x;
  for (const Vec3& X : instrument.shape->X) x.push_back(instrument.pose.apply(X));
  return make_surface_mesh({.x = x,
                            .X = instrument.shape->X,
                            .triangle = instrument.shape->triangle,
                            .crease_cosine = tool_crease_cosine});
}

}  // namespace

struct Renderer::Gl {
  int width, height;
  GlContext context;
  const GlFunctions& gl;
  std::optional<GlCurrent> current_while_made;
  GlPost post;
  GlProgram depth_only, tissue, instrument, background, enlarged;
  GlTarget samples, picture, shadow, cavity;
  GLuint field = 0, bump = 0;
  std::vector<GlMesh> meshes;  // tissue, then instruments; kept from frame to frame
  std::vector<std::uint8_t> rgba;
  PhaseTimers timers;

  Gl(int w, int h);
  void fill_meshes(const SceneView& scene);
  template <class Make>
  void fill(std::size_t k, const Make& make);
  void find_shade(const View& view, std::size_t n_meshes) const;
  void draw_depths(const GlTarget& target, double part, const Mat4f& projection,
                   std::size_t n_meshes) const;
  void draw_picture(const SceneView& scene, const View& view) const;
  void draw_tissue(const TissueView& view) const;
  void draw_instruments(const SceneView& scene) const;
  void draw_cavity(const SceneView& scene, const View& view) const;
  void use_with_light(const GlProgram& program, const View& view) const;
  void resolve() const;
  void read_back(Image& image);
};

Renderer::Gl::Gl(int w, int h)
    : width(checked_side(w, w, h)),
      height(checked_side(h, w, h)),
      gl(context.gl()),
      current_while_made(context),
      post(context, w, h),
      depth_only(make_program(context, "depth", surface_vertex(false), shader_depth_only)),
      tissue(make_program(context, "tissue", surface_vertex(true), with_light(shader_tissue))),
      instrument(make_program(context, "instrument", surface_vertex(false),
                              with_light(shader_instrument))),
      background(
          make_program(context, "background", shader_screen_vertex, with_light(shader_background))),
      enlarged(make_program(context, "enlarged", shader_screen_vertex, shader_enlarged)),
      samples(make_target(context, w, h,
                          {.colour = picture_format, .has_depth = true, .samples = n_samples})),
      picture(make_target(context, w, h,
                          {.colour = picture_format, .has_depth = true, .is_filtered = true})),
      shadow(make_target(context, shadow_side, shadow_side,
                         {.has_depth = true, .is_filtered = true, .is_shadow_map = true})),
      cavity(make_target(context, std::max(1, w / cavity_divisor), std::max(1, h / cavity_divisor),
                         {.colour = picture_format, .is_filtered = true})) {
  const TissuePattern pattern = make_tissue_pattern(pattern_side, pattern_cells);
  field = make_solid_texture(context, pattern.side, pattern.field);
  bump = make_solid_texture(context, pattern.side, pattern.bump);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  for (const char* name : phase_names) timers.phase(name);
  current_while_made.reset();
}

template <class Make>
void Renderer::Gl::fill(std::size_t k, const Make& make) {
  if (k == meshes.size()) meshes.push_back(make_gl_mesh(gl));
  SurfaceMesh surface;
  {
    PhaseScope scope(timers, normals_phase);
    surface = make();
  }
  PhaseScope scope(timers, upload_phase);
  upload(gl, meshes[k], surface);
}

void Renderer::Gl::fill_meshes(const SceneView& scene) {
  fill(0, [&] { return tissue_mesh(scene.tissue, scene.camera.eye); });
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    CHECK(scene.instruments[k].shape);
    fill(1 + k, [&] { return instrument_mesh(scene.instruments[k]); });
  }
}

// part: of the width, in the middle.
void Renderer::Gl::draw_depths(const GlTarget& target, double part, const Mat4f& projection,
                               std::size_t n_meshes) const {
  bind_target(gl, target);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  bind_middle(gl, target, part);
  depth_only.use();
  depth_only.set("projection", projection);
  for (std::size_t k = 0; k < n_meshes; ++k) trocar::draw(gl, meshes[k]);
}

// From depths alone, before surfaces are drawn.
void Renderer::Gl::find_shade(const View& view, std::size_t n_meshes) const {
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2.0f);
  draw_depths(shadow, 1, view.lamp_projection, n_meshes);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  draw_depths(picture, view.visible_part, view.projection, n_meshes);
  post.find_shade(picture.depth, shadow.depth, view);
}

void Renderer::Gl::use_with_light(const GlProgram& program, const View& view) const {
  use_with_view(program, view);
  program.set("shade_map", 0);
  program.set("field", 1);
  program.set("bump", 2);
}

void Renderer::Gl::draw_tissue(const TissueView& view) const {
  tissue.set("wetness", view.look.wetness);
  tissue.set("texture_size", view.look.texture_size);
  tissue.set("has_edges", view.has_edges ? 1.0 : 0.0);
  if (!view.is_two_sided) gl.Enable(GL_CULL_FACE);
  trocar::draw(gl, meshes[0]);
  gl.Disable(GL_CULL_FACE);
}

void Renderer::Gl::draw_instruments(const SceneView& scene) const {
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    instrument.set("colour", scene.instruments[k].colour);
    trocar::draw(gl, meshes[1 + k]);
  }
}

void Renderer::Gl::draw_cavity(const SceneView& scene, const View& view) const {
  gl.Disable(GL_DEPTH_TEST);
  bind_target(gl, cavity);
  use_with_light(background, view);
  background.set("target", scene.camera.target);
  post.fill_screen();
  gl.Enable(GL_DEPTH_TEST);
}

// Instruments first: they hide tissue, whose pixels cost more.
void Renderer::Gl::draw_picture(const SceneView& scene, const View& view) const {
  bind_texture(gl, 0, GL_TEXTURE_2D, post.shade());
  bind_texture(gl, 1, GL_TEXTURE_3D, field);
  bind_texture(gl, 2, GL_TEXTURE_3D, bump);
  draw_cavity(scene, view);
  bind_target(gl, samples);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);  // glow looks beyond the middle
  bind_middle(gl, samples, view.visible_part);
  use_with_light(instrument, view);
  draw_instruments(scene);
  use_with_light(tissue, view);
  draw_tissue(scene.tissue);
  bind_texture(gl, 0, GL_TEXTURE_2D, cavity.colour);
  enlarged.use();
  enlarged.set("depth", 0.999999);
  enlarged.set("picture", 0);
  post.fill_screen();
}

void Renderer::Gl::resolve() const {
  gl.Disable(GL_SCISSOR_TEST);  // it would hold for the copy, too
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, samples.framebuffer);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, picture.framebuffer);
  gl.BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Renderer::Gl::read_back(Image& image) {
  const std::size_t n_pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  rgba.resize(4 * n_pixels);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, post.output().framebuffer);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  image.width = width;
  image.height = height;
  image.rgb.resize(3 * n_pixels);
  for (std::size_t k = 0; k < n_pixels; ++k) std::copy_n(&rgba[4 * k], 3, &image.rgb[3 * k]);
}

Renderer::Renderer(int width, int height) : gl_(std::make_unique<Gl>(width, height)) {}
Renderer::~Renderer() = default;

void Renderer::draw(const SceneView& scene, Image& image) {
  Gl& g = *gl_;
  const View view = make_view(scene.camera, g.width, g.height);
  const GlCurrent current(g.context);
  g.fill_meshes(scene);
  {
    PhaseScope scope(g.timers, shade_phase);
    g.find_shade(view, 1 + scene.instruments.size());
    g.gl.Finish();
  }
  {
    PhaseScope scope(g.timers, surfaces_phase);
    g.draw_picture(scene, view);
    g.resolve();
    g.gl.Finish();
  }
  {
    PhaseScope scope(g.timers, post_phase);
    g.post.run(g.picture, view, scene.camera.has_endoscope_mask);
    g.gl.Finish();
  }
  PhaseScope scope(g.timers, read_back_phase);
  g.read_back(image);
  g.context.check("drawing a frame");
  draw_caption(image, scene.caption);
}

const PhaseTimers& Renderer::timers() const {
  return gl_->timers;
}

bool renderer_available(std::string& reason) {
  try {
    const GlContext context;
    return true;
  } catch (const MachineError& error) {
    reason = error.what();
    return false;
  }
}

}  // namespace trocar
