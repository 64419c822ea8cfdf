// What a frame tells: surface positions, forces on the instruments, energies, the wound.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// New surface positions on every rank. Collective.
void refresh_surface(Simulation& s);
// Forces on the instruments over the substeps; before a cut changes what touches them. Collective.
FrameRow report_forces(Simulation& s, const FrameSpan& span);
// The rest of the row, after the cut. Collective.
void report_state(Simulation& s, FrameRow& row);

}  // namespace trocar
