// GLSL of what darkens a surface, from the depths of the picture alone and at half its size: how
// open its surroundings are, and how much of the lamp's light arrives. Later passes look it up, a
// quarter as often as there are pixels and once a pixel however small the triangles.
#pragma once

namespace trocar {

// Creases: scalable ambient obscurance (McGuire 2012). r: openness, g: lit part, b: depth.
inline constexpr const char* shader_shade = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D depth_map;
uniform sampler2DShadow shadow_map;
uniform mat4 lamp_projection;
uniform vec3 eye, lamp, forward, right, up;
uniform float distance_scale;  // from the eye to its target [m]
uniform vec2 tan_half, near_far;
uniform float reach;           // [m]
out vec4 out_colour;

float depth_of(float z) {
  return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - (2.0 * z - 1.0) *
      (near_far.y - near_far.x));
}
// From the eye, along right, up and forward.
vec3 place(vec2 p) {
  ivec2 size = textureSize(depth_map, 0);
  float d = depth_of(texelFetch(depth_map, clamp(ivec2(p * vec2(size)), ivec2(0), size - 1), 0).r);
  return vec3((2.0 * p - 1.0) * tan_half, 1.0) * d;
}
vec3 in_world(vec3 d) { return d.x * right + d.y * up + d.z * forward; }

// llvmpipe takes both branches of an `if`, but leaves a loop that no pixel goes through: where
// there is nothing, is_near makes all loops empty.

// From six looks around the point: the penumbra is wide, for the lamp is a ring.
float lit_part(vec3 x, vec3 n, bool is_near) {
  if (dot(n, normalize(lamp - x)) < -0.3) return 0.0;
  vec4 h = lamp_projection * vec4(x + n * (0.004 * distance_scale), 1.0);
  vec3 s = h.xyz / h.w * 0.5 + 0.5;
  if (h.w <= 0.0 || s.x <= 0.0 || s.y <= 0.0 || s.x >= 1.0 || s.y >= 1.0) return 1.0;
  s.z -= 0.0004;
  const vec2 ring[6] = vec2[6](vec2(1.0, 0.0), vec2(0.5, 0.87), vec2(-0.5, 0.87), vec2(-1.0,
      0.0), vec2(-0.5, -0.87), vec2(0.5, -0.87));
  float lit = 0.0;
  for (int k = 0; k < (is_near ? 6 : 0); ++k) {
    float r = (k & 1) == 0 ? 0.0030 : 0.0012;
    lit += texture(shadow_map, vec3(s.xy + r * ring[k], s.z));
  }
  return lit / 6.0;
}

float openness(vec3 c, vec3 n, bool is_near) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int turn = ((pixel.x & 3) * 4 + (pixel.y & 3)) * 7 & 15;
  float angle = float(turn) * (6.2831853 / 16.0);
  vec2 dir = vec2(cos(angle), sin(angle));
  const vec2 golden = vec2(-0.737369, 0.675490);  // turns by 137.5 degrees
  float sum = 0.0;
  for (int k = 0; k < (is_near ? 8 : 0); ++k) {
    float r = reach * (float(k) + 0.6) / 8.0 / c.z * 0.5;
    vec3 d = place(at + r * dir / tan_half) - c;
    float dd = dot(d, d), far = reach * reach;
    float f = max(far - dd, 0.0) / far;
    sum += f * f * max(dot(d, n) - 0.012 * c.z * 0.25, 0.0) * inversesqrt(dd + 1e-12);
    dir = vec2(dir.x * golden.x - dir.y * golden.y, dir.x * golden.y + dir.y * golden.x);
  }
  return clamp(1.0 - sum * 0.46, 0.0, 1.0);
}

void main() {
  vec3 c = place(at);
  bool is_near = c.z <= 0.5 * near_far.y;
  vec3 n = normalize(cross(dFdy(c), dFdx(c)));
  if (dot(n, c) > 0.0) n = -n;
  float lit = lit_part(eye + in_world(c), in_world(n), is_near);
  out_colour = vec4(openness(c, n, is_near), is_near ? lit : 1.0, c.z, 1.0);
}
)glsl";

// Averages the 4 x 4 pixels whose directions differ, not across steps in depth.
inline constexpr const char* shader_shade_blur = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D shade;
out vec4 out_colour;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(shade, 0) - 1;
  float depth = texelFetch(shade, pixel, 0).b;
  vec2 sum = vec2(0.0);
  float weight = 0.0;
  for (int j = -2; j < 2; ++j)
    for (int i = -2; i < 2; ++i) {
      vec3 s = texelFetch(shade, clamp(pixel + ivec2(i, j), ivec2(0), last), 0).rgb;
      float w = abs(s.b - depth) < 0.03 * depth ? 1.0 : 0.02;
      sum += w * s.rg;
      weight += w;
    }
  out_colour = vec4(sum / weight, depth, 1.0);
}
)glsl";

}  // namespace trocar
