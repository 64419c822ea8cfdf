// A checkpoint in one piece.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/checkpoint.h"

namespace trocar {

inline std::vector<std::byte> checkpoint_to_bytes(Checkpoint checkpoint) {
  std::vector<std::byte> bytes;
  PackedRows packed;
  put_checkpoint(checkpoint, packed, [&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  return bytes;
}

}  // namespace trocar
