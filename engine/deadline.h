// The wall clock of a scene that runs in real time.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Until the deadline of the frame that has been computed, by the monotonic clock [s]; frame k's is
// k frames after the start, however late others were. Negative: it is past.
double left_of_frame(const Simulation& s, double now);
// Sleeps until the frame's deadline if the scene runs in real time, and counts a miss.
void wait_for_deadline(Simulation& s);

}  // namespace trocar
