// A checkpoint as an example, in one piece, and without what no two runs share.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
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

// Wall times are the only part that no two runs share.
inline Checkpoint without_wall_times(Checkpoint c) {
  auto rows = std::make_shared<std::vector<FrameRow>>(*c.rows);
  for (FrameRow& row : *rows) row.seconds = row.latency = 0;
  c.rows = std::move(rows);
  for (CutMemory& cut : c.cuts)
    for (CutRecord& stroke : cut.strokes) stroke.seconds = stroke.worst_seconds = 0;
  c.tally.n_deadlines_missed = 0;
  return c;
}

inline std::vector<std::byte> bytes_of(Simulation& s) {
  return checkpoint_to_bytes(without_wall_times(take_checkpoint(s)));
}

}  // namespace trocar
