// A plate one element thick that a cut in its plane, a little beside its middle, puts nodes on the
// edges of and splits: with all that hangs on nodes.
#pragma once

#include <string>

#include "scene_parts.h"

namespace trocar {

// 60 x 40 x 4.5 mm; `more` lines of the table of the solver.
inline std::string plate_of(const std::string& elements, const std::string& more = "") {
  return time_table("1 s", 50) + R"([tissue.shape]
kind = "box"
low = ["-30 mm", "-20 mm", 0]
high = ["30 mm", "20 mm", "4.5 mm"]
cells = [13, 9, 1]
elements = ")" +
         elements + "\"\n" + tissue_of_kpa(2) + "[cutting]\nsplit_step_ratio = 0.3\n" +
         solver_table("-0.3", 20) + more;
}

// Through all of it from 0.02 s to 0.3 s, and what is split is split at the end of that.
inline const std::string plate_blade = scalpel_along("60 mm", R"(
  { time = 0.02, position = ["-45 mm", "26 mm", "2.1 mm"], direction = [0, 1, 0] },
  { time = 0.3, position = ["45 mm", "26 mm", "2.3 mm"], direction = [0, 1, 0] },
)");

// Held at one side, in part at another, under a probe that rests on it, in a grasper and under
// loads. Marked in elements that are split.
inline const std::string plate_in_use = R"([[support]]
region = "x+"
[[region]]
name = "roller"
low = ["-31 mm", "-21 mm", "-1 mm"]
high = ["-20 mm", "-10 mm", "6 mm"]
[[support]]
region = "roller"
fix = "z"
[[load]]
region = "y+"
force = [0, "0.0005 N", 0]
[[load]]
region = "z-"
pressure = "0.2 Pa"
[[marker]]
name = "below"
position = ["3 mm", "2 mm", "1 mm"]
[[marker]]
name = "above"
position = ["3 mm", "2 mm", "4 mm"]
[[output]]
kind = "metrics"
file = "m.csv"
)" + probe_along(R"(
  { time = 0, position = ["16 mm", 0, "8 mm"] },
  { time = 0.1, position = ["16 mm", 0, "3.5 mm"] },
)") + grasper_along("9 mm", R"(
  { time = 0, position = ["-28 mm", "18 mm", "8 mm"] },
  { time = 0.04, position = ["-28 mm", "18 mm", "8 mm"], action = "close" },
  { time = 0.32, position = ["-28 mm", "18 mm", "8 mm"] },
  { time = 0.6, position = ["-30 mm", "19 mm", "10 mm"] },
)");
inline const std::string viscous = "[[tissue.material.prony]]\nshare = 0.3\ntime = 0.1\n";

}  // namespace trocar
