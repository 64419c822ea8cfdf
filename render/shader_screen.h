// GLSL of what fills the screen: the vertices of all such passes, and the cavity behind everything.
#pragma once

namespace trocar {

// A triangle over the whole target.
inline constexpr const char* shader_screen_vertex = R"glsl(#version 330 core
uniform float depth;  // 0 where nobody says another
out vec2 at;  // [0, 1], y up
void main() {
  at = vec2(float((gl_VertexID & 1) << 1), float(gl_VertexID & 2));
  gl_Position = vec4(2.0 * at - 1.0, depth, 1.0);
}
)glsl";

// The wall of the cavity, out of focus: the inside of a ball around the target.
inline constexpr const char* shader_background = R"glsl(
in vec2 at;
uniform sampler3D field;
uniform vec2 tan_half;
uniform vec3 target;
void main() {
  vec2 s = (2.0 * at - 1.0) * tan_half;
  vec3 d = normalize(forward + s.x * right + s.y * up);
  vec3 from = (eye - target) / distance_scale;
  const float radius = 1.9;
  float b = dot(from, d);
  float t = -b + sqrt(max(b * b - dot(from, from) + radius * radius, 0.0));
  vec3 hit = from + t * d;
  vec4 cloud = texture(field, 0.060 * hit + 0.31), fold = texture(field, 0.15 * hit + 0.7);
  vec3 c = mix(vec3(0.21, 0.050, 0.042), vec3(0.44, 0.22, 0.11), smoothstep(0.46, 0.70, cloud.r));
  c = mix(c, vec3(0.16, 0.016, 0.020), 0.8 * smoothstep(0.10, 0.0, abs(cloud.b - 0.5)));
  c *= 0.25 + 1.6 * fold.r * smoothstep(-0.10, 0.30, abs(fold.a - 0.5));
  float facing = max(dot(d, hit) / radius, 0.0);
  c *= lamp_colour * (0.25 + 1.5 * facing) / (0.4 + 0.6 * t * t) * mix(0.5, 1.0, smoothstep(0.5,
      1.0, dot(d, forward)));
  out_colour = vec4(compress(c), 1.0);
}
)glsl";

// A smooth picture of fewer pixels as the background.
inline constexpr const char* shader_enlarged = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D picture;
out vec4 out_colour;
void main() { out_colour = texture(picture, at); }
)glsl";

}  // namespace trocar
