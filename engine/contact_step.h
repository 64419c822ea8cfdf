// The stable step of tissue and of the contact that stiffens it.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Contact that stiffens triangles beneath curved tools (collision/contact_tilt) takes from the room
// that step_factor leaves; only what goes beyond it costs steps. After the frame. Collective. [s]
double stable_step_with_contact(Simulation& s, const FrameSpan& span);

}  // namespace trocar
