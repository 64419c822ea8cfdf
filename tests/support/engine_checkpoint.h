// A checkpoint as an example, and in one piece.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/checkpoint.h"

namespace trocar {

std::shared_ptr<std::vector<FrameRow>> rows_of(int n);
// Every kind of member once, with numbers that can't be mistaken for each other.
Checkpoint example_checkpoint();

inline std::vector<std::byte> checkpoint_to_bytes(Checkpoint checkpoint) {
  std::vector<std::byte> bytes;
  PackedRows packed;
  put_checkpoint(checkpoint, packed, [&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  return bytes;
}

}  // namespace trocar
