// The file of a run's checkpoint. It is replaced as a whole: a kill or a loss of power at any
// moment leaves the old one or the new one.
#pragma once

#include <functional>
#include <string>

#include "engine/bytes.h"
#include "engine/run_files.h"

namespace trocar {

// Writes a neighbour of that name with ".new" at its end, all that `put` gives to the sink, waits
// until it is on the disk, renames it. Throws MachineError "<file>: …" and leaves the old file as
// it was.
void replace_file(const std::string& file, const std::function<void(const ByteSink&)>& put);
// Checkpoint and what a kill left of a new one.
void remove_checkpoint(const std::string& folder);

}  // namespace trocar
