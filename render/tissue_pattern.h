// The procedural pattern of tissue: periodic solid noise, computed once and looked up by the
// shaders at several scales.
#pragma once

#include <cstdint>
#include <vector>

namespace trocar {

// Cubes of side^3 RGBA texels, x fastest, that repeat in all directions.
struct TissuePattern {
  int side = 0;
  // Cloudy noise; distance to the nearest cell centre less that to the second nearest (lobules: 0
  // at their borders); two signed fields around 0.5, whose zeros are sheets (vessels on a surface)
  // and, both together, curves (vessels in the depth).
  std::vector<std::uint8_t> field;
  // Gradient of the bumps (0.5 + 0.5 g) and their height.
  std::vector<std::uint8_t> bump;
};
// `side` texels hold n_cells cells a direction.
TissuePattern make_tissue_pattern(int side, int n_cells);

}  // namespace trocar
