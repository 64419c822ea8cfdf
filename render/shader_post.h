// GLSL of the passes over the whole picture: glow of the highlights, and the composite with tone
// curve, sRGB and the endoscope's mask. They start with #version, unlike the surfaces' shaders.
#pragma once

namespace trocar {

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
uniform sampler2D picture, shade, glow;
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
  float open = texture(shade, turned).r;
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
