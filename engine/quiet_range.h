// What acts on a body while some of it sleeps: forces on instruments, ways of supports. Sleepers
// have been quiet while these varied within some range; beyond it they may move, though what is
// awake around them, which they hold, hardly does.
#pragma once

#include <span>
#include <vector>

namespace trocar {

struct QuietRange {
  std::vector<double> recent;     // (n_frames * n) n / 3 vectors a frame, the newest last
  std::vector<double> low, high;  // (n) where sleepers may stay; empty: nobody sleeps
};

// Keeps the last n_frames. values (n).
void note_actions(std::span<const double> values, std::size_t n_frames, QuietRange& range);
// For who falls asleep now, having been quiet in all frames that are kept. Vectors may go beyond by
// this share of themselves.
void narrow_range(std::size_t n, double share, QuietRange& range);
// Whether the newest are outside.
bool leave_range(const QuietRange& range);

}  // namespace trocar
