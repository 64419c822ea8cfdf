// GLSL of the vertices of tissue and instruments, and of passes that want their depth alone.
#pragma once

namespace trocar {

// IS_TISSUE: has colours of its own and a swell, the widest bumps of the pattern, which stretch
// over many triangles.
inline constexpr const char* shader_surface_vertex = R"glsl(
in vec3 in_position, in_reference, in_normal;
in vec4 in_edge, in_mark;
uniform mat4 projection;
out vec3 x, X, normal;
out vec3 edge;
out vec2 mark;
#ifdef IS_TISSUE
in vec3 in_colour;
uniform sampler3D bump;
uniform float texture_size;
out vec3 swell;
flat out vec3 colour;
#endif
void main() {
  x = in_position;
  X = in_reference;
  normal = in_normal;
  edge = in_edge.xyz;
  mark = in_mark.xy;
#ifdef IS_TISSUE
  colour = in_colour;
  swell = textureLod(bump, 0.13 * X / texture_size, 0.0).xyz - 0.5;
#endif
  gl_Position = projection * vec4(x, 1.0);
}
)glsl";

inline constexpr const char* shader_depth_only = R"glsl(#version 330 core
void main() {}
)glsl";

}  // namespace trocar
