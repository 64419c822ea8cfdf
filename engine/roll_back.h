// What is done about a frame that went wrong: once more from its beginning, with smaller steps.
#pragma once

#include <string>

#include "engine/simulation.h"

namespace trocar {

inline constexpr int most_roll_backs = 4;

// Notes that the frame is done again with the stable step of its end, which its own exceeded;
// throws as roll_back does.
void repeat_frame(Simulation& s, const FrameSpan& span, int tries);
// Halves the step for what follows; throws SimulationError after most_roll_backs tries, which says
// where and beside what. `failed`: of the frame. Collective.
void roll_back(Simulation& s, const FrameSpan& span, const Watch& failed,
               const std::string& trouble, int tries);

}  // namespace trocar
