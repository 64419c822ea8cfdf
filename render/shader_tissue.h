// GLSL of wet soft tissue: outer surface (capsule, mottled, fine vessels) and cut face (lobules,
// opened vessels, blood). The pattern is looked up at the reference position, so that it sticks to
// the tissue.
#pragma once

namespace trocar {

inline constexpr const char* shader_tissue = R"glsl(
in vec3 x, X, normal;
in vec3 edge;
in vec2 mark;         // is_cut, rim
in vec3 swell;        // of the pattern
flat in vec3 colour;  // of the outer surface, or of the cut
uniform sampler3D field, bump;
uniform float wetness, texture_size;
uniform float has_edges;

struct Skin {
  vec3 albedo;
  vec3 slope;      // of the bumps
  float film;      // [0, 1] thickness of the liquid on it
  float roughness;
};

vec3 slope_at(vec3 p) { return texture(bump, p).xyz - 0.5; }

// The pattern at three scales. Both kinds of skin use the same looks:
// llvmpipe takes both branches of an `if`.

struct Looks {
  vec4 wide, near, fine;  // field
  vec3 bump, grain;       // slopes
};

Skin outer_skin(Looks k) {
  Skin s;
  float mottle = (k.wide.r - 0.5) + 0.6 * (k.near.r - 0.5);
  s.albedo = colour * (0.92 + 1.1 * mottle);
  s.albedo = mix(s.albedo, colour * vec3(1.10, 1.70, 1.30), 0.45 * smoothstep(0.54, 0.82,
      k.near.r));
  s.albedo = mix(s.albedo, colour * vec3(0.46, 0.32, 0.46), 0.65 * smoothstep(0.58, 0.26,
      k.wide.r));
  s.albedo *= 0.90 + 0.18 * smoothstep(0.0, 0.35, k.fine.g) + 0.30 * (k.fine.r - 0.5);
  // Vessels lie where the field is zero; they thin out where the cloud is dark.
  float trunk = abs(k.wide.b - 0.5) * 9.0, branch = abs(k.near.a - 0.5) * 6.0;
  float vessel = (1.0 - smoothstep(0.02, 0.13, trunk)) * smoothstep(0.40, 0.55, k.wide.r);
  vessel = max(vessel, 0.7 * (1.0 - smoothstep(0.01, 0.12, branch)) * smoothstep(0.45, 0.62,
      k.near.r));
  s.albedo = mix(s.albedo, colour * vec3(0.55, 0.13, 0.30), 0.55 * vessel);
  s.slope = 0.8 * swell + 0.62 * k.bump + 0.25 * k.grain;
  s.film = smoothstep(0.34, 0.60, 0.6 * k.near.r + 0.4 * k.wide.r);
  s.roughness = mix(0.36, 0.19, s.film);
  return s;
}

// depth: 0 at the rim, 1 an element or more below it.
Skin cut_skin(Looks k, float depth) {
  Skin s;
  float inside = smoothstep(0.0, 0.36, k.fine.g);
  s.albedo = colour * mix(vec3(0.75, 0.40, 0.38), vec3(1.25, 1.12, 1.08), inside);
  s.albedo *= 0.75 + 0.50 * k.fine.r + 0.9 * (k.near.r - 0.5);
  // A vessel runs where both fields vanish; cut across it shows a pale wall around a dark opening.
  float tube = length(k.near.ba - 0.5);
  float wall = 1.0 - smoothstep(0.040, 0.060, tube), opening = 1.0 - smoothstep(0.012, 0.032, tube);
  s.albedo = mix(s.albedo, vec3(0.42, 0.20, 0.16), 0.6 * wall);
  s.albedo = mix(s.albedo, vec3(0.17, 0.012, 0.013), 0.85 * opening);
  // Blood seeps over it.
  float blood = smoothstep(0.44, 0.64, 0.6 * k.near.r + 0.4 * k.fine.r);
  s.albedo = mix(s.albedo, vec3(0.34, 0.010, 0.011), 0.62 * blood);
  s.albedo *= mix(vec3(1.0), vec3(0.72, 0.50, 0.50), depth);  // light is lost between the walls
  s.slope = 0.5 * swell + 0.9 * k.bump + 0.9 * k.grain;
  s.film = 0.6 + 0.4 * blood;
  s.roughness = mix(0.34, 0.20, blood);
  return s;
}

// The cut edge of the capsule: a bloody line, ragged by noise, that fades into the surface.
void bleed_at_rim(inout Skin s, float rim, float ragged) {
  float line = smoothstep(0.55, 0.95, rim + 0.6 * ragged);
  float stain = smoothstep(0.15, 0.9, rim + 0.7 * ragged) * step(0.01, rim);
  s.albedo = mix(s.albedo, s.albedo * vec3(0.80, 0.38, 0.38), 0.8 * stain);
  s.albedo = mix(s.albedo, vec3(0.15, 0.006, 0.008), 0.85 * line);
  s.film = max(s.film, stain);
}

// Light scatters in tissue, red farthest: the border of shade is soft and red.
vec3 soft_diffuse(float nl, float lit) {
  const vec3 wrap = vec3(0.42, 0.16, 0.12);
  vec3 d = clamp((vec3(nl) + wrap) / (1.0 + wrap), 0.0, 1.0);
  vec3 shade = mix(vec3(0.14, 0.045, 0.04), vec3(1.0), lit);
  return d * d * (1.6 - 0.6 * d) * shade;
}

// Two lamps, the second beside the lens; the liquid film is smoother than what lies below.
vec3 shine(Skin s, vec3 n, vec3 v, vec3 l, float lit, float strength) {
  vec3 across = s.slope - n * dot(n, s.slope);
  vec3 bumpy = normalize(n - 1.1 * across), smoother = normalize(n - 0.75 * across);
  float wet = wetness * s.film;
  float broad = glint(bumpy, v, l, mix(0.55, 0.42, wetness), 0.03);
  float sharp = lit * min(glint(smoother, v, l, s.roughness, 0.026), 5.0);
  sharp += 0.35 * min(glint(smoother, v, normalize(v - 0.10 * right + 0.05 * up), s.roughness +
      0.04, 0.026), 5.0);
  float m = 1.0 - max(dot(smoother, v), 0.0), m2 = m * m;
  vec3 mirror = cavity_glow(reflect(-v, smoother)) * (0.03 + 0.6 * m2 * m2 * m) * (0.4 + 0.6 * wet);
  return lamp_colour * strength * (0.7 * lit * broad + 1.2 * wet * sharp) + mirror;
}

void main() {
  vec3 p = X / texture_size;
  bool is_cut = mark.x > 0.5;
  Skin s;
  Looks k;
  k.wide = texture(field, 0.10 * p);
  k.near = texture(field, 0.27 * p);
  k.fine = texture(field, 1.25 * p);
  k.bump = slope_at(0.45 * p);
  k.grain = slope_at(1.6 * p);
  if (is_cut) s = cut_skin(k, 1.0 - mark.y); else s = outer_skin(k);
  if (!is_cut) bleed_at_rim(s, mark.y, k.fine.r - 0.5);

  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  vec3 v = normalize(eye - x), l = normalize(lamp - x);
  vec3 bumpy = normalize(n - 0.75 * (s.slope - n * dot(n, s.slope)));
  float strength = lamp_strength(x);
  float lit = dot(n, l) > -0.3 ? lit_part(x) : 0.0;

  vec3 light = 0.86 * lamp_colour * strength * soft_diffuse(dot(bumpy, l), lit);
  // second light guide, at the lens
  light += 0.11 * strength * vec3(1.0, 0.82, 0.76) * max(dot(bumpy, v), 0.0);
  light += vec3(0.050, 0.024, 0.024) * (0.7 + 0.3 * dot(bumpy, up));
  vec3 c = s.albedo * light + shine(s, n, v, l, lit, strength);

  if (has_edges > 0.5) {
    vec3 w = edge / max(fwidth(edge), 1e-6);
    float d = min(w.x, min(w.y, w.z));
    c = mix(c, c * 0.25 + vec3(0.01, 0.005, 0.005), 0.62 * (1.0 - smoothstep(0.5, 1.5, d)));
  }
  out_colour = vec4(compress(c), 1.0);
}
)glsl";

}  // namespace trocar
