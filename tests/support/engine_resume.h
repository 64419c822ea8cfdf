// Small scenes with all that a run keeps from frame to frame, for the tests of checkpoints:
// contact, grasped nodes, a moving support, cuts. About 0.1 s of computing a simulated second.
#pragma once

#include <string>

#include "scene_parts.h"

namespace trocar {

// Tetrahedra, pressed by a probe from 0.1 s, held by a grasper from 0.2 s to 0.9 s, cut from 0.25 s
// to 0.75 s, moved by a support.
inline const std::string resume_block_text = "name = \"resumed block\"\n" + time_table("1.2 s") +
                                             R"([tissue.shape]
kind = "box"
elements = "tet4-five"
low = ["-30 mm", "-20 mm", "0 mm"]
high = ["30 mm", "20 mm", "30 mm"]
cells = [8, 5, 4]
)" + tissue_of_kpa(6) + solver_table("-9.81", 20) +
                                             R"([cutting]
resistance = "10 N/m"
[[support]]
region = "z-"
fix = "xyz"
[[support]]
region = "x+"
path = [
  { time = "0.2 s", displacement = [0, 0, 0] },
  { time = "1.0 s", displacement = ["1 mm", 0, 0] },
]
[[instrument]]
kind = "probe"
radius = "5 mm"
path = [
  { time = "0.1 s", position = ["18 mm", "-8 mm", "34 mm"] },
  { time = "0.5 s", position = ["18 mm", "-8 mm", "25 mm"] },
  { time = "1.0 s", position = ["18 mm", "-8 mm", "40 mm"] },
]
[[instrument]]
kind = "grasper"
grip_radius = "9 mm"
path = [
  { time = "0.2 s", position = ["-28 mm", "18 mm", "30 mm"], action = "close" },
  { time = "0.6 s", position = ["-32 mm", "22 mm", "32 mm"] },
  { time = "0.9 s", position = ["-32 mm", "22 mm", "32 mm"], action = "open" },
]
[[instrument]]
kind = "scalpel"
blade_length = "20 mm"
path = [
  { time = "0.1 s", position = ["-45 mm", "1 mm", "12 mm"] },
  { time = "0.25 s", position = ["-33 mm", "1 mm", "12 mm"] },
  { time = "0.7 s", position = ["4 mm", "1 mm", "12 mm"] },
  { time = "0.9 s", position = ["4 mm", "1 mm", "50 mm"] },
]
)";

// Triangles, cut in pieces, pulled by a support.
inline const std::string resume_plane_text = "name = \"resumed plane\"\n" + time_table("1.2 s") +
                                             R"([tissue]
thickness = "5 mm"
[tissue.shape]
kind = "rectangle"
high = ["70 mm", "40 mm", 0]
cells = [20, 16, 1]
)" + tissue_of_kpa(6) + R"([solver]
mass_damping = "20 1/s"
[[support]]
region = "x-"
fix = "xyz"
[[support]]
region = "x+"
path = [ { time = "0.1 s", displacement = [0, 0, 0] }, { time = "1.0 s", displacement = ["4 mm", 0, 0] } ]
[[instrument]]
kind = "scalpel"
radius = "2 mm"
path = [
  { time = "0.1 s", position = ["17.8 mm", "35.2 mm", "30 mm"], forward = [23.8, -17.2, 0] },
  { time = "0.3 s", position = ["17.8 mm", "35.2 mm", 0], forward = [23.8, -17.2, 0] },
  { time = "0.9 s", position = ["41.6 mm", "18.0 mm", 0], forward = [23.8, -17.2, 0] },
  { time = "1.0 s", position = ["41.6 mm", "18.0 mm", "40 mm"], forward = [23.8, -17.2, 0] },
]
)";

// A plate 30 mm wide, which scissors of 20 mm close on from 0.2 s to 0.4 s: it lies beside their
// jaws, too.
inline const std::string resume_snip_text =
    time_table("0.5 s") + tissue_of_kpa(6) + solver_table("0", 20) + R"([tissue.shape]
kind = "box"
low = ["-15 mm", "-20 mm", 0]
high = ["15 mm", "20 mm", "5 mm"]
cells = [24, 16, 2]
elements = "tet4-kuhn"
[[support]]
region = "y-"
[[support]]
region = "y+"
[[instrument]]
kind = "scissors"
blade_length = "20 mm"
path = [
  { time = 0, position = [0, "1 mm", "30 mm"], direction = [0, 0, -1] },
  { time = 0.15, position = [0, "1 mm", "-3 mm"], direction = [0, 0, -1] },
  { time = 0.4, position = [0, "1 mm", "-3 mm"], direction = [0, 0, -1], action = "close" },
]
)";

}  // namespace trocar
