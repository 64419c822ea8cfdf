// When a running scene writes its checkpoint, and what the outputs add to it.
#pragma once

#include "engine/checkpoint.h"
#include "engine/output.h"

namespace trocar {

// The end of this frame is one of [checkpoint] every.
bool is_checkpoint_due(const Simulation& s);
// Replaces the checkpoint by one of this moment, after all that the outputs wrote so far is safe on
// the disk; nothing if it is there already or the scene wants none. failed: of the frame that was
// under way, null between frames; a cut that failed can't be taken back, so the last checkpoint
// stays. Collective; throws MachineError on every rank.
void write_checkpoint(Simulation& s, Outputs& outputs, const FrameStart* failed = nullptr);

}  // namespace trocar
