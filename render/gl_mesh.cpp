#include "render/gl_mesh.h"

#include <cstddef>

namespace trocar {

namespace {

void set_attribute(const GlFunctions& gl, GLuint number, GLint size, GLenum type,
                   std::size_t offset) {
  gl.EnableVertexAttribArray(number);
  const GLboolean is_fraction = type == GL_UNSIGNED_BYTE ? GL_TRUE : GL_FALSE;
  gl.VertexAttribPointer(number, size, type, is_fraction, sizeof(SurfaceVertex),
                         reinterpret_cast<const void*>(offset));
}

}  // namespace

GlMesh make_gl_mesh(const GlFunctions& gl) {
  GlMesh mesh;
  gl.GenVertexArrays(1, &mesh.vertex_array);
  gl.GenBuffers(1, &mesh.vertex_buffer);
  gl.GenBuffers(1, &mesh.index_buffer);
  gl.BindVertexArray(mesh.vertex_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, mesh.vertex_buffer);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.index_buffer);
  set_attribute(gl, 0, 3, GL_FLOAT, offsetof(SurfaceVertex, x));
  set_attribute(gl, 1, 3, GL_FLOAT, offsetof(SurfaceVertex, X));
  set_attribute(gl, 2, 3, GL_FLOAT, offsetof(SurfaceVertex, normal));
  set_attribute(gl, 3, 4, GL_UNSIGNED_BYTE, offsetof(SurfaceVertex, edge));
  set_attribute(gl, 4, 4, GL_UNSIGNED_BYTE, offsetof(SurfaceVertex, mark));
  set_attribute(gl, 5, 3, GL_FLOAT, offsetof(SurfaceVertex, colour));
  gl.BindVertexArray(0);
  return mesh;
}

void upload(const GlFunctions& gl, GlMesh& mesh, const SurfaceMesh& surface) {
  gl.BindVertexArray(mesh.vertex_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, mesh.vertex_buffer);
  gl.BufferData(GL_ARRAY_BUFFER,
                static_cast<GLsizeiptr>(surface.vertex.size() * sizeof(SurfaceVertex)),
                surface.vertex.data(), GL_STREAM_DRAW);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                static_cast<GLsizeiptr>(surface.index.size() * sizeof(std::uint32_t)),
                surface.index.data(), GL_STREAM_DRAW);
  gl.BindVertexArray(0);
  mesh.n_indices = static_cast<GLsizei>(surface.index.size());
}

void draw(const GlFunctions& gl, const GlMesh& mesh) {
  if (mesh.n_indices == 0) return;
  gl.BindVertexArray(mesh.vertex_array);
  gl.DrawElements(GL_TRIANGLES, mesh.n_indices, GL_UNSIGNED_INT, nullptr);
  gl.BindVertexArray(0);
}

}  // namespace trocar
