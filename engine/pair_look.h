// Tissue that may meet tissue is looked for at a frame's beginning, as far as its velocities take
// it and half an edge beyond (detect_tissue). Within the frame supports set out, tissue is hit and
// bounces: where it has come farther than that from where it was expected, it is looked for anew.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// What contacts ask of the simulation.
ContactBody contact_body(const Simulation& s);

// Remembers a look at the beginning of substep k.
void note_pair_look(Simulation& s, const FrameSpan& span, std::int64_t k);

// Whether tissue has come so far in the frame, at the beginning of substep k, that pairs may be
// missing. Collective.
bool is_pair_look_due(Simulation& s, const FrameSpan& span, std::int64_t k);

// Finds the pairs of tissue and tissue of the rest of the frame, from substep k on; those of tools
// and tissue stay. Collective.
void look_for_pairs(Simulation& s, const FrameSpan& span, std::int64_t k);

// Warns, once a run, of the first frame at whose end tissue lies deeper in other tissue than pairs
// are found: it will not come out of it. The view is of the frame's end. Not of a frame with an
// edit. Collective.
void watch_sunk_tissue(Simulation& s, double time);

}  // namespace trocar
