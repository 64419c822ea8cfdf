// GLSL of brushed metal.
#pragma once

namespace trocar {

inline constexpr const char* shader_instrument = R"glsl(
in vec3 x, X, normal;
in vec3 edge;
in vec2 mark;
uniform sampler3D field;
uniform vec3 colour;

// Streaks round the shaft: fine along it, long across.
float streak(vec3 p) {
  return texture(field, vec3(60.0 * p.xy, 900.0 * p.z)).r + 0.5 * texture(field, vec3(90.0 *
      p.xy, 2700.0 * p.z)).a - 0.75;
}

void main() {
  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  vec3 v = normalize(eye - x), l = normalize(lamp - x);
  float s = streak(X);
  vec3 brushed = normalize(n + 0.05 * s * up + 0.03 * s * right);
  float strength = min(lamp_strength(x), 2.2), lit = lit_part(x);

  vec3 r = reflect(-v, brushed);
  // The room in the metal: bright round the lens, dark to the sides, red from the tissue below.
  float to_lens = 0.5 - 0.5 * dot(r, forward);
  float sky = smoothstep(0.50, 0.98, to_lens), side = smoothstep(0.30, 0.62, to_lens) *
      (1.0 - smoothstep(0.62, 0.80, to_lens));
  vec3 seen = vec3(0.85, 0.84, 0.82) * sky * sky * min(strength, 1.4) + vec3(0.10, 0.085,
      0.085) * side;
  seen += vec3(0.17, 0.045, 0.035) * smoothstep(0.55, 0.0, to_lens) + vec3(0.012);
  seen += vec3(0.20, 0.19, 0.19) * smoothstep(0.80, 0.95, dot(r, up));
  float m = 1.0 - max(dot(n, v), 0.0), m2 = m * m;
  vec3 f = colour + (1.0 - colour) * m2 * m2 * m;
  vec3 c = f * seen * (0.40 + 0.60 * lit) * (1.0 + 0.25 * s);
  c += f * lamp_colour * strength * lit * min(0.10 * glint(brushed, v, l, 0.40, 0.9) + 0.05 *
      glint(n, v, l, 0.18, 0.9), 2.0);
  c += colour * 0.09 * strength * max(dot(n, l), 0.0) * mix(0.3, 1.0, lit);
  out_colour = vec4(compress(c), 1.0);
}
)glsl";

}  // namespace trocar
