// Small scenes, each of which does something that the others don't, for digests on ranks and
// threads. A body has about a thousand elements, so that two threads share it on one rank and on
// two, and takes some hundred steps, for which it is soft.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scene_parts.h"

namespace trocar {

struct SmallScene {
  std::string name;
  std::string text;             // TOML
  std::string first_half = "";  // duration of a first run, which is resumed; "": it runs through
};

inline std::string scene_start(const std::string& duration) {
  return time_table(duration, 50);
}

struct SmallBlock {
  std::string elements = "tet4-five", cells = "[9, 6, 5]";
  std::string duration = "0.36 s", solver = "", material = "";  // more lines of their tables
  std::string supports = "[[support]]\nregion = \"z-\"\n";
};

inline const std::string soft_tissue = tissue_of_kpa(2);
inline const std::string heavy = solver_table("-3", 20);
inline const std::string at_rest = "[start]\nstate = \"equilibrium\"\ntolerance = 1e-4\n";

// 60 x 40 x 30 mm.
inline std::string block(const SmallBlock& b) {
  return scene_start(b.duration) + "[tissue.shape]\nkind = \"box\"\nelements = \"" + b.elements +
         "\"\nlow = [\"-30 mm\", \"-20 mm\", 0]\nhigh = [\"30 mm\", \"20 mm\", \"30 mm\"]\ncells "
         "= " +
         b.cells + "\n" + soft_tissue + b.material + heavy + b.solver +
         "[cutting]\nresistance = \"3 N/m\"\n" + b.supports;
}

inline SmallBlock hexahedra(const std::string& solver = "") {
  return {.elements = "hex8", .cells = "[14, 9, 8]", .solver = solver};
}

inline const std::string probe = probe_along(R"(
  { time = 0, position = ["18 mm", "-8 mm", "36 mm"] },
  { time = 0.12, position = ["18 mm", "-8 mm", "25 mm"] },
  { time = 0.3, position = ["18 mm", "-8 mm", "40 mm"] },
)");
inline const std::string late_probe = probe_along(R"(
  { time = 0.7, position = ["18 mm", "-8 mm", "36 mm"] },
  { time = 0.8, position = ["18 mm", "-8 mm", "26 mm"] },
)");
// Into small cells, where what it stiffens is a small part of the body.
inline const std::string slow_probe = probe_along(R"(
  { time = 0, position = ["18 mm", "-8 mm", "35.2 mm"] },
  { time = 0.16, position = ["18 mm", "-8 mm", "26 mm"] },
  { time = 0.3, position = ["18 mm", "-8 mm", "41 mm"] },
)");
inline const std::string grasper = grasper_along("9 mm", R"(
  { time = 0, position = ["-44 mm", "34 mm", "48 mm"] },
  { time = 0.1, position = ["-28 mm", "18 mm", "30 mm"], action = "close" },
  { time = 0.2, position = ["-32 mm", "22 mm", "32 mm"] },
  { time = 0.3, position = ["-32 mm", "22 mm", "32 mm"], action = "open" },
)");
// So fast that steps which were stable become too long, and elements are inverted.
inline const std::string hasty_grasper = grasper_along("9 mm", R"(
  { time = 0, position = ["-44 mm", "34 mm", "48 mm"] },
  { time = 0.1, position = ["-28 mm", "18 mm", "30 mm"], action = "close" },
  { time = 0.14, position = ["5 mm", "18 mm", "30 mm"] },
)");
inline const std::string moving_support = R"([[support]]
region = "x+"
path = [
  { time = 0, displacement = [0, 0, 0] },
  { time = 0.3, displacement = ["2 mm", 0, 0] },
]
)";

inline std::string scalpel(const std::string& keys, const std::string& name = "scalpel") {
  return scalpel_along("40 mm", keys) + "name = \"" + name + "\"\n";
}
inline const std::string partial_cut = scalpel(R"(
  { time = 0.02, position = ["-45 mm", "1 mm", "12 mm"] },
  { time = 0.08, position = ["-33 mm", "1 mm", "12 mm"] },
  { time = 0.28, position = ["5 mm", "1 mm", "12 mm"] },
  { time = 0.36, position = ["5 mm", "1 mm", "50 mm"] },
)");
inline const std::string late_cut = scalpel(R"(
  { time = 0.62, position = ["-45 mm", "1 mm", "12 mm"] },
  { time = 0.68, position = ["-33 mm", "1 mm", "12 mm"] },
  { time = 0.84, position = ["-5 mm", "1 mm", "12 mm"] },
)");
inline const std::string through_cut = scalpel(R"(
  { time = 0.02, position = ["1 mm", "-24 mm", "-4 mm"], forward = [0, 1, 0] },
  { time = 0.34, position = ["2 mm", "34 mm", "-4 mm"], forward = [0, 1, 0] },
)");
inline const std::string curved_cut = scalpel(R"(
  { time = 0.02, position = ["-26 mm", "-24 mm", "12 mm"], forward = [0.6, 0.8, 0] },
  { time = 0.14, position = ["-12 mm", "-8 mm", "12 mm"], forward = [0.8, 0.6, 0] },
  { time = 0.24, position = ["4 mm", "-4 mm", "12 mm"], forward = [1, 0, 0] },
  { time = 0.36, position = ["20 mm", "-12 mm", "12 mm"], forward = [0.8, -0.6, 0] },
)");
// Cuts off what then slides down on the rest of the block.
inline const std::string slanted_cut = scalpel_along("60 mm", R"(
  { time = 0.02, position = ["-45 mm", "26 mm", "2.9 mm"], direction = [0, 0.906, -0.423] },
  { time = 0.26, position = ["45 mm", "26 mm", "2.9 mm"], direction = [0, 0.906, -0.423] },
)");
inline const std::string touching_tissue = "[contact]\ntissue = true\nfriction = 0.1\n";
inline const std::string crossing_cuts = scalpel(R"(
  { time = 0.02, position = ["-34 mm", "-4 mm", "14 mm"], forward = [1, 0.1, 0] },
  { time = 0.26, position = ["34 mm", "4 mm", "14 mm"], forward = [1, 0.1, 0] },
)") + scalpel(R"(
  { time = 0.32, position = ["-2 mm", "-24 mm", "12 mm"], forward = [0.1, 1, 0] },
  { time = 0.5, position = ["2 mm", "24 mm", "12 mm"], forward = [0.1, 1, 0] },
)",
              "second scalpel");

// One element thick, cut along itself.
inline const std::string plate =
    scene_start("0.36 s") + R"([tissue.shape]
kind = "box"
elements = "tet4-five"
low = ["-30 mm", "-20 mm", 0]
high = ["30 mm", "20 mm", "4.5 mm"]
cells = [13, 9, 1]
)" + soft_tissue +
    "[[tissue.material.prony]]\nshare = 0.3\ntime = 0.1\n" + solver_table("-0.3", 20) +
    "[cutting]\nsplit_step_ratio = 0.3\n[[support]]\nregion = \"x+\"\n" + scalpel_along("60 mm", R"(
  { time = 0.02, position = ["-45 mm", "26 mm", "2.1 mm"], direction = [0, 1, 0] },
  { time = 0.3, position = ["45 mm", "26 mm", "2.3 mm"], direction = [0, 1, 0] },
)");

// The plane body of configs/plane_cut.toml with finer cells, cut in half the time.
inline std::string plane(const std::string& solver, const std::string& duration = "0.5 s",
                         const std::string& right = moving_support) {
  return scene_start(duration) + "[tissue]\nthickness = \"5 mm\"\n[tissue.shape]\n" +
         "kind = \"rectangle\"\nhigh = [\"70 mm\", \"40 mm\", 0]\ncells = [28, 22, 1]\n" +
         soft_tissue + "[solver]\nmass_damping = \"20 1/s\"\n" + solver +
         "[[support]]\nregion = \"x-\"\n" + right;
}
inline const std::string plane_cut = R"([[instrument]]
kind = "scalpel"
radius = "2 mm"
path = [
  { time = 0.02, position = ["17.8 mm", "35.2 mm", "30 mm"], forward = [23.8, -17.2, 0] },
  { time = 0.1, position = ["17.8 mm", "35.2 mm", 0], forward = [23.8, -17.2, 0] },
  { time = 0.35, position = ["41.6 mm", "18.0 mm", 0], forward = [23.8, -17.2, 0] },
  { time = 0.4, position = ["41.6 mm", "18.0 mm", "40 mm"], forward = [23.8, -17.2, 0] },
]
)";

// On a body at rest that is asleep.
inline const std::string late_plane_cut = R"([[instrument]]
kind = "scalpel"
radius = "2 mm"
path = [
  { time = 0.62, position = ["17.8 mm", "35.2 mm", "30 mm"], forward = [23.8, -17.2, 0] },
  { time = 0.7, position = ["17.8 mm", "35.2 mm", 0], forward = [23.8, -17.2, 0] },
  { time = 0.85, position = ["41.6 mm", "18.0 mm", 0], forward = [23.8, -17.2, 0] },
  { time = 0.9, position = ["41.6 mm", "18.0 mm", "40 mm"], forward = [23.8, -17.2, 0] },
]
)";

// A stretched duct between open blades, which close.
inline const std::string duct = scene_start("0.5 s") + R"([tissue.shape]
kind = "cylinder"
elements = "tet4-kuhn"
radius = "5 mm"
height = "40 mm"
cells = [4, 4, 12]
)" + soft_tissue + "[solver]\nmass_damping = \"15 1/s\"\n[[support]]\nregion = \"z-\"\n" +
                                R"(
[[support]]
region = "z+"
path = [ { time = 0, displacement = [0, 0, 0] }, { time = 0.2, displacement = [0, 0, "4 mm"] } ]
[[instrument]]
kind = "scissors"
radius = "2.5 mm"
blade_length = "30 mm"
path = [
  { time = 0, position = ["30 mm", 0, "21 mm"], direction = [-1, 0, 0], forward = [0, 1, 0] },
  { time = 0.15, position = ["-13 mm", 0, "21 mm"], direction = [-1, 0, 0], forward = [0, 1, 0] },
  { time = 0.4, position = ["-13 mm", 0, "21 mm"], direction = [-1, 0, 0], forward = [0, 1, 0], action = "close" },
]
)";

// Three materials, half hexahedra and half tetrahedra (mixed_mesh), which lies beside the scene.
inline const char* const mixed_file = "mixed.msh";
inline const std::string mixed = scene_start("0.36 s") + R"([tissue]
mesh = "mixed.msh"
[[tissue.region_material]]
region = "b"
material = { model = "yeoh", c1 = "1.5 kPa", poisson_ratio = 0.4 }
[[tissue.region_material]]
region = "c"
material = { model = "linear", young_modulus = "4 kPa", poisson_ratio = 0.4 }
[[region]]
name = "bottom"
low = ["-1 mm", "-1 mm", "-1 mm"]
high = ["61 mm", "31 mm", "1 mm"]
)" + soft_tissue + heavy + "[[support]]\nregion = \"bottom\"\n" +
                                 probe_along(R"(
  { time = 0, position = ["45 mm", "15 mm", "36 mm"] },
  { time = 0.2, position = ["45 mm", "15 mm", "24 mm"] },
)");

// A block with a layer of thin elements at x = 5 mm (with_thin_layer), hung at its left side.
inline const char* const layer_files[] = {"layer-hex8.msh", "layer-tet4.msh"};
inline std::string layered(const char* file, const std::string& solver,
                           const std::string& duration) {
  return scene_start(duration) + "[tissue]\nmesh = \"" + file + "\"\n" + soft_tissue +
         solver_table("-1", 20) + "multirate = true\n" + solver + held_left;
}
// Held at its left side alone the block takes more than a second to come to rest.
inline const std::string held_right = "[[support]]\nregion = \"x+\"\n";
// On the layer.
inline const std::string layer_probe = probe_along(R"(
  { time = 0, position = ["6 mm", "12 mm", "36 mm"] },
  { time = 0.15, position = ["6 mm", "12 mm", "26 mm"] },
)");
inline const std::string late_layer_probe = probe_along(R"(
  { time = 0.62, position = ["6 mm", "12 mm", "36 mm"] },
  { time = 0.75, position = ["6 mm", "12 mm", "26 mm"] },
)");
inline const std::string layer_grasper = grasper_along("6 mm", R"(
  { time = 0, position = ["6 mm", "-20 mm", "-14 mm"] },
  { time = 0.1, position = ["6 mm", 0, "6 mm"], action = "close" },
  { time = 0.2, position = ["8 mm", "-2 mm", "5 mm"] },
)");
inline const std::string layer_cut = scalpel(R"(
  { time = 0.04, position = ["16 mm", "-4 mm", "12 mm"], forward = [0, 1, 0] },
  { time = 0.3, position = ["14 mm", "20 mm", "12 mm"], forward = [0, 1, 0] },
)");

inline const std::string loads =
    "[[load]]\nregion = \"z+\"\npressure = \"150 Pa\"\n[[load]]\nregion = \"y+\"\n"
    "force = [0, 0.02, 0.01]\npath = [{ time = 0, factor = 0.2 }, { time = 0.2, factor = 1 }]\n";

// The cut moves the lowest node, from which positions in single precision are counted.
inline const std::string ball_cut_at_its_pole = scene_start("0.36 s") + R"([tissue.shape]
kind = "ball"
elements = "hex8"
radius = "30 mm"
cells = [12, 12, 12]
)" + soft_tissue + heavy + R"([[region]]
name = "side"
low = ["15 mm", -1, -1]
high = [1, 1, 1]
[[support]]
region = "side"
)" + scalpel_along("24 mm", R"(
  { time = 0, position = ["-6 mm", "0.5 mm", "-40 mm"], direction = [-1, 0, 0], forward = [0, 0, 1] },
  { time = 0.2, position = ["-6 mm", "0.5 mm", "-12 mm"], direction = [-1, 0, 0], forward = [0, 0, 1] },
)");

// Sums of products of 1e-40 J and less while the equilibrium is sought.
inline const std::string tiny_forces = time_table("0.05 s") + R"([tissue.shape]
kind = "box"
cells = [10, 10, 10]
high = ["5 mm", "5 mm", "5 mm"]
[tissue.material]
young_modulus = "1 kPa"
[[support]]
region = "x-"
[[load]]
region = "x+"
force = ["1e-11 N", 0, 0]
[start]
state = "equilibrium"
)";

// With metrics of a point on either side of the middle in x, where two ranks meet. [m]
inline std::string marked(double middle, const std::string& yz) {
  std::string text = metrics_table;
  for (const double x : {middle - 0.001, middle + 0.001})
    text += "[[marker]]\nname = \"" + std::string(x < middle ? "left" : "right") +
            "\"\nposition = [" + std::to_string(x) + ", " + yz + "]\n";
  return text;
}

inline std::vector<SmallScene> small_scenes() {
  const std::string prony = "prony = [ { share = 0.4, time = \"0.1 s\" } ]\n";
  const std::string held_sides = "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n";
  const std::string scaled = "mass_scaling_step = \"1.04 ms\"\n", sleep = "sleep = \"0.3 mm\"\n";
  SmallBlock parted = {.duration = "0.4 s", .supports = held_sides};
  SmallBlock crossed = {.duration = "0.54 s"};
  SmallBlock sleepy = hexahedra(sleep), sleepy_tet = {.duration = "0.9 s", .solver = sleep};
  sleepy.duration = "0.9 s";
  const SmallBlock small_cells = {.elements = "hex8", .cells = "[36, 24, 18]", .duration = "0.2 s"};
  SmallBlock hasty = hexahedra();
  hasty.duration = "0.24 s";
  SmallBlock viscous_hex = hexahedra(), viscous_tet;
  viscous_hex.material = viscous_tet.material = prony;
  SmallBlock viscous_enhanced = hexahedra("hexahedron = \"enhanced\"\n");
  viscous_enhanced.material = prony;
  return {
      {"tet4, pressed and pulled", block({}) + probe + grasper},
      {"tet4 with nodal pressures, pressed",
       block({.elements = "tet4-kuhn", .solver = "tetrahedron = \"nodal-pressure\"\n"}) + probe},
      {"hex8, pressed and pulled", block(hexahedra()) + probe + grasper},
      {"hex8, pulled so fast that frames are rolled back", block(hasty) + hasty_grasper},
      {"hex8 in small cells, pressed, resumed", block(small_cells) + slow_probe, "0.16 s"},
      {"hex8 enhanced, pulled",
       block(hexahedra("hexahedron = \"enhanced\"\n")) + grasper + moving_support},
      {"hex8 full, pressed and pulled",
       block(hexahedra("hexahedron = \"full\"\n")) + probe + moving_support},
      {"mixed elements and materials, pressed", mixed},
      {"tri3, cut and pulled", plane("") + plane_cut + marked(0.035, "0.021, 0")},
      {"tri3 in plane stress under pressure, cut and pulled",
       plane("triangle = \"plane-stress\"\n") + plane_cut +
           "[[load]]\nregion = \"y+\"\npressure = \"-100 Pa\"\n"},
      {"tri3 with scaled masses, cut and pulled",
       plane(scaled) + plane_cut + marked(0.035, "0.021, 0")},
      {"hex8 viscoelastic from equilibrium, pressed", block(viscous_hex) + at_rest + probe},
      {"tet4 viscoelastic, cut", block(viscous_tet) + partial_cut},
      {"tet4, cut in two", block(parted) + through_cut},
      {"tet4, crossing cuts", block(crossed) + crossing_cuts},
      {"tet4 viscoelastic plate, nodes put on edges by a cut, resumed", plate, "0.2 s"},
      {"hex8, curved cut", block(hexahedra()) + curved_cut},
      {"hex8 viscoelastic, curved cut, resumed", block(viscous_hex) + curved_cut, "0.26 s"},
      {"hex8 enhanced viscoelastic, pressed and cut, resumed",
       block(viscous_enhanced) + probe + partial_cut, "0.2 s"},
      {"hex8 and tetrahedra with nodal pressures, curved cut",
       block(hexahedra("tetrahedron = \"nodal-pressure\"\n")) + curved_cut},
      {"tet4, slanted cut, one piece sliding on the other, resumed",
       block({}) + touching_tissue + slanted_cut, "0.28 s"},
      {"hex8, curved cut, its lips touching and pressed",
       block(hexahedra()) + touching_tissue + curved_cut + probe},
      {"tet4 with nodal pressures, cut and pulled",
       block({.solver = "tetrahedron = \"nodal-pressure\"\n"}) + partial_cut + grasper},
      {"duct, cut by scissors", duct},
      {"hex8 asleep, pressed", block(sleepy) + at_rest + late_probe + marked(0, "0.002, 0.02")},
      {"tet4 asleep, cut", block(sleepy_tet) + at_rest + late_cut},
      {"tri3 asleep with scaled masses, cut",
       plane("mass_scaling_step = \"0.61 ms\"\nsleep = \"0.5 mm\"\n", "1 s",
             "[[support]]\nregion = \"x+\"\n") +
           late_plane_cut},
      // All in one cluster, so that other ranks have none.
      {"tet4 with scaled masses, falls asleep",
       block({.elements = "tet4-kuhn",
              .cells = "[8, 6, 3]",
              .duration = "1.2 s",
              .solver = sleep + "mass_scaling_step = \"2 ms\"\n"})},
      {"hex8 with local steps, pressed and pulled",
       layered(layer_files[0], "", "0.3 s") + layer_probe + layer_grasper},
      {"hex8 with local steps asleep, pressed",
       layered(layer_files[0], sleep, "0.8 s") + held_right + at_rest + late_layer_probe},
      {"tet4 with local steps, pressed, pulled and cut, resumed",
       layered(layer_files[1], "", "0.36 s") + layer_probe + layer_grasper + layer_cut, "0.2 s"},
      {"tet4, pulled by a force, under pressure and cut, resumed", block({}) + loads + partial_cut,
       "0.2 s"},
      {"hex8 viscoelastic, under pressure from equilibrium", block(viscous_hex) + at_rest + loads},
      {"tet4, pulled and cut, resumed", block({}) + grasper + partial_cut, "0.2 s"},
      {"hex8 of a few mm, in equilibrium under next to nothing", tiny_forces},
      {"hex8 ball, cut at its pole, resumed", ball_cut_at_its_pole, "0.2 s"},
      {"hex8 from equilibrium, cut, resumed", block(hexahedra()) + at_rest + curved_cut, "0.26 s"},
  };
}

inline std::string small_scene(const std::string& name) {
  for (const SmallScene& scene : small_scenes())
    if (scene.name == name) return scene.text;
  throw std::invalid_argument("no scene \"" + name + "\"");
}

}  // namespace trocar
