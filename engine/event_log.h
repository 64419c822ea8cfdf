// What happened in a run, in sentences: in the log of the summary and, on rank 0, on the terminal.
#pragma once

#include <string>
#include <string_view>

#include "engine/simulation.h"

namespace trocar {

void note_event(Simulation& s, double time, const std::string& event);
// The same as a warning.
void warn_event(Simulation& s, double time, const std::string& event);
// Whether an event has this in it. The log remembers, over a resumption too.
bool is_told(const Simulation& s, std::string_view part);

}  // namespace trocar
