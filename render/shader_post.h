// GLSL of the passes over the whole picture: ambient occlusion, glow of the highlights, and the
// composite with tone curve, sRGB and the endoscope's mask. They start with #version, unlike the
// surfaces' shaders.
#pragma once

namespace trocar {

// Darkness of creases from depth alone (scalable ambient obscurance, McGuire 2012), at half size.
// r: openness, g: depth.
inline constexpr const char* shader_occlusion = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D depth_map;
uniform vec2 tan_half, near_far;
uniform float reach;           // [m]
out vec4 out_colour;

float depth_of(float z) {
  return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - (2.0 * z - 1.0) *
      (near_far.y - near_far.x));
}
vec3 place(vec2 p) {
  float d = depth_of(texture(depth_map, p).r);
  return vec3((2.0 * p - 1.0) * tan_half, 1.0) * d;
}
void main() {
  vec3 c = place(at);
  if (c.z > 0.5 * near_far.y) { out_colour = vec4(1.0, c.z, 0.0, 1.0); return; }
  vec3 n = normalize(cross(dFdy(c), dFdx(c)));
  if (dot(n, c) > 0.0) n = -n;
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int turn = ((pixel.x & 3) * 4 + (pixel.y & 3)) * 7 & 15;
  float angle = float(turn) * (6.2831853 / 16.0);
  vec2 dir = vec2(cos(angle), sin(angle));
  const vec2 golden = vec2(-0.737369, 0.675490);  // turns by 137.5 degrees
  float sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    float r = reach * (float(k) + 0.6) / 8.0 / c.z * 0.5;
    vec3 d = place(at + r * dir / tan_half) - c;
    float dd = dot(d, d), far = reach * reach;
    float f = max(far - dd, 0.0) / far;
    sum += f * f * max(dot(d, n) - 0.012 * c.z * 0.25, 0.0) * inversesqrt(dd + 1e-12);
    dir = vec2(dir.x * golden.x - dir.y * golden.y, dir.x * golden.y + dir.y * golden.x);
  }
  out_colour = vec4(clamp(1.0 - sum * 0.46, 0.0, 1.0), c.z, 0.0, 1.0);
}
)glsl";

// Averages the 4 x 4 pixels whose directions differ, not across steps in depth.
inline constexpr const char* shader_occlusion_blur = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D occlusion;
out vec4 out_colour;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(occlusion, 0) - 1;
  float depth = texelFetch(occlusion, pixel, 0).g;
  float sum = 0.0, weight = 0.0;
  for (int j = -2; j < 2; ++j)
    for (int i = -2; i < 2; ++i) {
      vec2 o = texelFetch(occlusion, clamp(pixel + ivec2(i, j), ivec2(0), last), 0).rg;
      float w = abs(o.g - depth) < 0.03 * depth ? 1.0 : 0.02;
      sum += w * o.r;
      weight += w;
    }
  out_colour = vec4(sum / weight);
}
)glsl";

// What is brighter than white, at a quarter of the size, smeared by two passes (axis x, then y).
inline constexpr const char* shader_glow = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D picture;
uniform vec2 spacing;      // of the looks, in the picture's [0, 1]
uniform float is_first;
out vec4 out_colour;
void main() {
  const float weight[5] = float[5](0.20, 0.17, 0.12, 0.07, 0.04);
  vec3 sum = vec3(0.0);
  for (int k = -4; k <= 4; ++k) {
    vec3 c = texture(picture, at + float(k) * spacing).rgb;
    if (is_first > 0.5) {
      c = c / max(1.0 - max(c.r, max(c.g, c.b)), 0.02);
      c = max(c - 0.9, 0.0);
      c = c / (1.0 + 0.25 * max(c.r, max(c.g, c.b)));
    }
    sum += weight[abs(k)] * c;
  }
  out_colour = vec4(sum, 1.0);
}
)glsl";

inline constexpr const char* shader_composite = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D picture, occlusion, glow;
uniform float aspect, is_endoscope, mask_radius;
out vec4 out_colour;

// Filmic curve (Narkowicz 2015, a fit of the Academy's), then IEC 61966-2-1.
vec3 tone(vec3 c) { return clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0,
    1.0); }
vec3 srgb(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055, step(0.0031308,
      c));
}
// One of 16 x 16 levels between two grey values, so that dark gradients show no bands.
float dither(ivec2 p) {
  int a = p.x ^ p.y, b = p.y, v = 0;
  for (int k = 0; k < 4; ++k) v |= ((a >> k) & 1) << (7 - 2 * k) | ((b >> k) & 1) << (6 - 2 * k);
  return (float(v) + 0.5) / 256.0 - 0.5;
}
void main() {
  vec2 turned = vec2(at.x, 1.0 - at.y);  // rows leave top-down
  vec3 c = texture(picture, turned).rgb;
  c = c / max(1.0 - max(c.r, max(c.g, c.b)), 0.02);
  float open = texture(occlusion, turned).r;
  // Creases of tissue stay red: light bounces between their walls.
  c *= vec3(open * (1.2 - 0.2 * open), open * open, open * open);
  c += 0.16 * texture(glow, turned).rgb;
  vec2 s = (2.0 * at - 1.0) * vec2(aspect, 1.0);
  float r = length(s);
  c *= 1.0 - 0.10 * smoothstep(0.5, 1.9, r);
  if (is_endoscope > 0.5) c *= (1.0 - 0.45 * smoothstep(0.55, 1.22, r)) *
      (1.0 - smoothstep(mask_radius - 0.03, mask_radius, r));
  c = srgb(tone(c));
  out_colour = vec4(c + dither(ivec2(gl_FragCoord.xy)) / 255.0, 1.0);
}
)glsl";

}  // namespace trocar
