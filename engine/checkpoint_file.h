// The file of a run's checkpoint. It is replaced as a whole: a kill or a loss of power at any
// moment leaves the old one or the new one.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace trocar {

inline constexpr const char* checkpoint_name = "checkpoint.bin";

// Writes a neighbour of that name with ".new" at its end, waits until it is on the disk, renames
// it. Throws MachineError "<file>: …" and leaves the old file as it was.
void replace_file(const std::string& file, std::span<const std::byte> bytes);
// Checkpoint and what a kill left of a new one.
void remove_checkpoint(const std::string& folder);

}  // namespace trocar
