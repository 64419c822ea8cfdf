// The unit cube in which blades leave strips and slices out.
#pragma once

#include "cutting_tet.h"

namespace trocar::cutting_test {

inline constexpr int n_cells = 6;
inline constexpr double cell = 1.0 / n_cells;

// Nodes off their places by up to `jittered` cells.
inline Body cube(BoxElements elements = BoxElements::tet4_kuhn, double jittered = 0) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {n_cells, n_cells, n_cells}, elements);
  if (jittered > 0) jitter(mesh, jittered, 3);
  return Body(std::move(mesh));
}

}  // namespace trocar::cutting_test
