// Nodes speak, not outer facets: along a body's edge, or where older cuts have left a wedge, each
// facet of a slice has a corner on the other side.
#include "cutting/cut_slice.h"

#include <algorithm>
#include <cmath>

namespace trocar {

// Side of node i if it is lost, else 0.
static int lost_side(const CutSurroundings& around, const CutLabels& labels, std::int32_t i) {
  if (!(std::abs(around.distance[i]) > thinnest_slice * around.h)) return 0;
  const int side = around.distance[i] > 0 ? 1 : -1;
  const auto is_other = [&](std::int32_t e) { return labels.side[e] == -side; };
  return around.patch.is_whole(i) && std::ranges::all_of(around.patch.star(i), is_other) ? side : 0;
}

// The deepest first.
static std::vector<std::int32_t> lost_nodes(const CutSurroundings& around,
                                            std::span<const std::int32_t> parted,
                                            const CutLabels& labels) {
  std::vector<std::int32_t> lost;
  for (std::int32_t i = 0; i < around.patch.n_nodes(); ++i)
    if (lost_side(around, labels, i) != 0 &&
        !std::ranges::binary_search(parted, around.patch.node[i]))
      lost.push_back(i);
  std::ranges::stable_sort(lost, std::ranges::greater{},
                           [&](std::int32_t i) { return std::abs(around.distance[i]); });
  return lost;
}

static void set_sides(std::span<const std::int32_t> element, int side, CutLabels& labels) {
  for (const std::int32_t e : element) labels.side[e] = static_cast<std::int8_t>(side);
}

// Whether a node of the elements, not nearer to the surface than node i, has lost `side`.
static bool has_lost_deeper(const CutSurroundings& around, const CutLabels& labels,
                            std::span<const std::int32_t> element, std::int32_t i, int side) {
  return std::ranges::any_of(element, [&](std::int32_t e) {
    return std::ranges::any_of(around.patch.corner[e], [&](std::int32_t j) {
      return std::abs(around.distance[j]) >= std::abs(around.distance[i]) &&
             lost_side(around, labels, j) == side;
    });
  });
}

std::vector<std::int32_t> join_slices(const CutSurroundings& around,
                                      std::span<const std::int32_t> parted,
                                      std::span<const std::int32_t> decided, CutLabels& labels) {
  std::vector<std::int32_t> joined;
  std::vector<std::uint8_t> is_free(around.patch.element.size(), 0);
  for (const std::int32_t e : decided) is_free[e] = 1;
  for (const std::int32_t i : lost_nodes(around, parted, labels)) {
    const int side = around.distance[i] > 0 ? 1 : -1;
    std::vector<std::int32_t> star;
    for (const std::int32_t e : around.patch.star(i))
      if (is_free[e] != 0) star.push_back(e);
    set_sides(star, side, labels);
    if (has_lost_deeper(around, labels, star, i, -side)) {
      set_sides(star, -side, labels);
      continue;
    }
    for (const std::int32_t e : star) is_free[e] = 0;
    joined.insert(joined.end(), star.begin(), star.end());
  }
  std::ranges::sort(joined);
  return joined;
}

}  // namespace trocar
