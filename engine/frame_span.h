// The time of a frame and of its substeps.
#pragma once

#include <cstdint>

namespace trocar {

struct FrameSpan {
  double t0 = 0, t1 = 0;  // [s]
  double dt = 0;          // of a substep [s]
  std::int64_t n_substeps = 1;
  // At which substep k begins [s].
  double time(std::int64_t k) const { return t0 + static_cast<double>(k) * dt; }
};

}  // namespace trocar
