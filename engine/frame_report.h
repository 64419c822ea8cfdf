// What a frame tells: surface positions, forces on the instruments, energies, the wound.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/simulation.h"

namespace trocar {

// New surface positions on every rank. Collective.
void refresh_surface(Simulation& s);
// Forces on the instruments over the substeps; before a cut changes what touches them. Collective.
FrameRow report_forces(Simulation& s, const FrameSpan& span);
// The rest of the row, after the cut. Collective.
void report_state(Simulation& s, FrameRow& row);
// To the log of the summary and, on rank 0, to the terminal.
void note_event(Simulation& s, double time, const std::string& event);
// Whether an event has this in it. The log remembers, over a resumption too.
bool is_told(const Simulation& s, std::string_view part);
// The same as a warning.
void warn_event(Simulation& s, double time, const std::string& event);
void note_grasp(Simulation& s, double time, const GraspAct& act);
// At the end of a stroke: how much the blade left joined, and the first place with its reason.
void note_refusals(Simulation& s, const CutRecord& record);
// At the end of a run: strokes that have not ended, blades that have cut nothing, and probes that
// have touched nothing.
void note_idle_tools(Simulation& s);
// 64-bit digest of nodes, velocities, connectivity, time and step; equal for any number of ranks
// and threads. Collective.
std::uint64_t state_digest(const Simulation& s);

}  // namespace trocar
