// Parts of scenes as text (TOML) that many small scenes of the tests have alike.
#pragma once

#include <string>

namespace trocar {

inline std::string time_table(const std::string& duration, int frame_rate = 30) {
  return "[time]\nduration = \"" + duration + "\"\nframe_rate = \"" + std::to_string(frame_rate) +
         " Hz\"\n";
}

inline std::string tissue_of_kpa(int young_modulus) {
  return "[tissue.material]\nyoung_modulus = \"" + std::to_string(young_modulus) +
         " kPa\"\npoisson_ratio = 0.4\n";
}

// Gravity [m/s^2] along z, mass damping [1/s]; more lines of the table may follow.
inline std::string solver_table(const std::string& gravity, int mass_damping) {
  return "[solver]\ngravity = [0, 0, \"" + gravity + " m/s^2\"]\nmass_damping = \"" +
         std::to_string(mass_damping) + " 1/s\"\n";
}

inline const std::string metrics_table = "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n";

// The block of with_thin_layer, held at its left side.
inline const std::string held_left = R"([[region]]
name = "left"
low = ["-1 mm", "-1 mm", "-1 mm"]
high = ["1 mm", "31 mm", "31 mm"]
[[support]]
region = "left"
)";

// `size`: the line that says how large it is; `keys`: lines of its path.
inline std::string instrument(const std::string& kind, const std::string& size,
                              const std::string& keys) {
  return "[[instrument]]\nkind = \"" + kind + "\"\n" + size + "\npath = [\n" + keys + "]\n";
}
inline std::string probe_along(const std::string& keys) {
  return instrument("probe", "radius = \"5 mm\"", keys);
}
inline std::string grasper_along(const std::string& grip_radius, const std::string& keys) {
  return instrument("grasper", "grip_radius = \"" + grip_radius + "\"", keys);
}
inline std::string scalpel_along(const std::string& blade_length, const std::string& keys) {
  return instrument("scalpel", "blade_length = \"" + blade_length + "\"", keys);
}

// A bar of 120 x 20 x 20 mm on the table, at rest in its weight; behind a time_table.
inline std::string bar_on_table() {
  return tissue_of_kpa(6) + solver_table("-9.81", 30) + R"([start]
state = "equilibrium"
[checkpoint]
every = 0
[tissue.shape]
kind = "box"
low = ["-60 mm", "-10 mm", "0 mm"]
high = ["60 mm", "10 mm", "20 mm"]
cells = [24, 4, 4]
[[support]]
region = "z-"
)";
}

}  // namespace trocar
