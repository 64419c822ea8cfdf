// A surface on the GPU, filled anew for each frame.
#pragma once

#include <array>

#include "render/gl_context.h"
#include "render/surface_mesh.h"

namespace trocar {

// Names of the vertex attributes in the shaders; the place is the attribute's number.
inline constexpr std::array<const char*, 6> gl_attribute_names = {
    "in_position", "in_reference", "in_normal", "in_edge", "in_mark", "in_colour"};

struct GlMesh {
  GLuint vertex_array = 0, vertex_buffer = 0, index_buffer = 0;
  GLsizei n_indices = 0;
};

GlMesh make_gl_mesh(const GlFunctions& gl);
void upload(const GlFunctions& gl, GlMesh& mesh, const SurfaceMesh& surface);
void draw(const GlFunctions& gl, const GlMesh& mesh);

}  // namespace trocar
