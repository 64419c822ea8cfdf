// Deadlines of a scene that runs in real time: each frame is to be done a frame's length after the
// one before, outputs and checkpoint included. What follows from a frame's time is apart from clock
// and sleep, so that tests have a clock of their own.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/simulation.h"

namespace trocar {

using PhaseTotals = std::vector<std::pair<std::string, double>>;  // of PhaseTimers

// What a frame that is done finds.
struct Deadline {
  double late = 0;   // behind it; 0: in time [s]
  double wait = 0;   // until the next frame begins [s]
  double shift = 0;  // of this deadline and all later ones [s]
};
// now: since the scene's time zero, by a clock that may jump [s]. Forwards that is lateness. Who is
// earlier than a frame's length finds a clock that went back, which moves the deadlines with it: no
// frame waits for longer than its length.
Deadline deadline_of(const SceneTime& time, std::int64_t frame, double now);

// Frames of this process begin: the clock is at the time of the scene. Collective in real time.
void start_clock(Simulation& s);
// In real time counts a miss, then sleeps until the next frame is to begin. A frame is done when
// the last rank is. Collective in real time.
Deadline wait_for_deadline(Simulation& s);

// Whether the run ends with a frame that found this.
bool ends_run(const SceneTime& time, const Deadline& deadline);
// Why, with the phase that took most of this rank's time since the timers had these totals.
std::string missed_text(const Simulation& s, const Deadline& deadline, const PhaseTotals& before);

}  // namespace trocar
