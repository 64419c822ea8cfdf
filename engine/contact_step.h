// The stable step where contact stiffens the tissue.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Contact that stiffens triangles beneath curved tools (collision/contact_tilt) takes from the room
// that step_factor leaves; only what goes beyond it costs steps: the most that a step may be then,
// infinite otherwise. After the frame. Collective. [s]
double step_limit_of_contact(Simulation& s, const FrameSpan& span);

}  // namespace trocar
