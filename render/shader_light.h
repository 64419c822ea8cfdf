// GLSL shared by all surfaces: the lamp at the endoscope's tip, the cavity's glow, and what is
// written. Fragments write radiance / (1 + its greatest part): averaging the samples of a
// pixel then keeps the edges of highlights smooth (Karis 2013). The composite pass (shader_post.h)
// undoes it.
#pragma once

namespace trocar {

inline constexpr const char* shader_light = R"glsl(
uniform vec3 eye, lamp, forward, right, up;
uniform float distance_scale;       // from the eye to its target
uniform sampler2D shade_map;
out vec4 out_colour;

const float PI = 3.14159265;
const vec3 lamp_colour = vec3(1.0, 0.965, 0.92);

vec3 compress(vec3 c) { return c / (1.0 + max(c.r, max(c.g, c.b))); }

// Share of the lamp's light that arrives, from the half-size shade around that is as deep.
float lit_part(vec3 x) {
  float depth = dot(x - eye, forward), sum = 0.0, weight = 1e-9;
  vec2 at = 0.5 * gl_FragCoord.xy - 0.5, part = fract(at);
  ivec2 first = ivec2(floor(at)), last = textureSize(shade_map, 0) - 1;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec3 s = texelFetch(shade_map, clamp(first + corner, ivec2(0), last), 0).rgb;
    vec2 w = mix(1.0 - part, part, vec2(corner));
    float same = abs(s.b - depth) < 0.02 * depth ? 1.0 : 1e-3;
    sum += same * w.x * w.y * s.g;
    weight += same * w.x * w.y;
  }
  return sum / weight;
}

// Falls off with distance and towards the border of the lamp's cone.
float lamp_strength(vec3 x) {
  vec3 d = x - eye;
  float r = length(d) / distance_scale;
  float cone = smoothstep(0.45, 0.98, dot(d, forward) / (r * distance_scale));
  return mix(0.35, 1.0, cone) / (0.12 + 0.88 * r * r);
}

// Microfacet reflection (GGX, Walter 2007; Schlick's Fresnel; Smith's visibility by
// Hammon 2017), times n.l.
float glint(vec3 n, vec3 v, vec3 l, float roughness, float f0) {
  vec3 h = normalize(v + l);
  float a = roughness * roughness, a2 = a * a;
  float nh = max(dot(n, h), 0.0), nl = max(dot(n, l), 0.0), nv = max(dot(n, v), 0.02);
  float q = nh * nh * (a2 - 1.0) + 1.0;
  float d = a2 / (PI * q * q);
  float vis = 0.5 / (mix(2.0 * nl * nv, nl + nv, a) + 1e-4);
  float m = 1.0 - max(dot(v, h), 0.0), m2 = m * m;
  return d * vis * (f0 + (1.0 - f0) * m2 * m2 * m) * nl;
}

// What a mirror sees of the cavity: dark red walls, brighter round the endoscope.
vec3 cavity_glow(vec3 d) {
  float to_eye = 0.5 - 0.5 * dot(d, forward);
  float above = 0.5 + 0.5 * dot(d, up);
  vec3 wall = mix(vec3(0.055, 0.012, 0.010), vec3(0.20, 0.085, 0.065), above);
  return wall * (0.35 + 1.3 * to_eye * to_eye);
}
)glsl";

}  // namespace trocar
