// What moves where a frame failed: so that the sentence about it names what the user can change.
#pragma once

#include <string>

#include "engine/simulation.h"

namespace trocar {

struct Suspect {
  std::string place;  // " at (0.03, 0.01, 0.02) m, 0.0004 m from ..."
  std::string cure;   // "a slower or shorter path of ..., a finer mesh or a lower poisson_ratio"
};
// Where the element or node that `failed` blames is in the present state, that of the frame's
// beginning, and the instrument that comes nearest to it within the frame, or the nearest held node
// or moving support. Collective.
Suspect find_suspect(Simulation& s, const Watch& failed, const FrameSpan& span);

}  // namespace trocar
