// Outer facets that lie on one side of the surface, and nodes whose elements are all crossed.
#include "cutting/cut_slice.h"

#include <algorithm>

namespace trocar {

// Side that all three nodes of a facet lie on, clear of the surface; 0: none.
static int clear_side(const CutSurroundings& around, const std::array<std::int32_t, 3>& node) {
  int sum = 0;
  const double clear = thinnest_slice * around.h;
  for (const std::int32_t i : node)
    sum += (around.distance[i] > clear ? 1 : 0) - (around.distance[i] < -clear ? 1 : 0);
  return sum / 3;
}

int slice_side(const CutSurroundings& around, const CutStroke& stroke, const CutLabels& labels,
               std::int32_t e, int f) {
  const CutPatch& patch = around.patch;
  const std::uint8_t* opened = find_element(stroke.opened, patch.element[e]);
  if (opened != nullptr && (*opened >> f & 1) != 0) return 0;
  const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
  const int side = clear_side(around, node);
  const auto is_mute = [&](std::int32_t u) {
    return is_unknown(labels, u) || labels.side[u] == -side;
  };
  const auto is_unspoken = [&](std::int32_t i) {
    return patch.is_whole(i) && std::ranges::all_of(patch.star(i), is_mute);
  };
  return side != 0 && std::ranges::any_of(node, is_unspoken) ? side : 0;
}

}  // namespace trocar
