// Looks at the elements around a neck only: farther away, ends may hang together around the blade.
#include "cutting/cut_neck.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/cut_slice.h"

namespace trocar {

static bool is_clear(const CutSurroundings& around, std::int32_t i, int side) {
  return side * around.distance[i] > thinnest_slice * around.h;
}

// By the middle of the element or by its farthest corner.
static bool lies_on(const CutSurroundings& around, std::int32_t e, int side) {
  double sum = 0, farthest = 0;
  for (const std::int32_t i : around.patch.corner[e]) {
    const double phi = side * around.distance[i];
    sum += phi;
    if (std::abs(phi) > std::abs(farthest)) farthest = phi;
  }
  return sum > 0 || farthest > 0;
}

// Marks those that got the other side than they lie on.
static std::vector<std::uint8_t> wrong_elements(const CutSurroundings& around,
                                                std::span<const std::int32_t> decided,
                                                const CutLabels& labels, int side) {
  std::vector<std::uint8_t> is_wrong(around.patch.element.size(), 0);
  const auto is_clear_here = [&](std::int32_t i) { return is_clear(around, i, side); };
  for (const std::int32_t e : decided)
    is_wrong[e] = labels.side[e] == -side &&
                  std::ranges::any_of(around.patch.corner[e], is_clear_here) &&
                  lies_on(around, e, side);
  return is_wrong;
}

// Takes `first` out of `is_wrong` and all that hangs together with it at clear nodes.
static std::vector<std::int32_t> take_neck(const CutSurroundings& around, std::int32_t first,
                                           int side, std::vector<std::uint8_t>& is_wrong) {
  std::vector<std::int32_t> neck{first};
  is_wrong[first] = 0;
  for (std::size_t k = 0; k < neck.size(); ++k)
    for (const std::int32_t i : around.patch.corner[neck[k]]) {
      if (!is_clear(around, i, side)) continue;
      for (const std::int32_t u : around.patch.star(i))
        if (std::exchange(is_wrong[u], std::uint8_t{0}) != 0) neck.push_back(u);
    }
  return neck;
}

// Takes `first` out of `is_in` and all that hangs together with it there through facets.
static void take_piece(const CutPatch& patch, std::int32_t first,
                       std::vector<std::uint8_t>& is_in) {
  std::vector<std::int32_t> piece{first};
  is_in[first] = 0;
  for (std::size_t k = 0; k < piece.size(); ++k)
    for (const std::int32_t u : patch.across[piece[k]])
      if (u >= 0 && std::exchange(is_in[u], std::uint8_t{0}) != 0) piece.push_back(u);
}

// Whether the neck reaches the body's surface and lies between pieces of its own side.
static bool parts_slice(const CutPatch& patch, const CutLabels& labels, int side,
                        const std::vector<std::int32_t>& neck) {
  std::vector<std::int32_t> end;
  bool reaches_surface = false;
  for (const std::int32_t e : neck)
    for (int f = 0; f < 4; ++f) {
      const std::int32_t u = patch.across[e][f];
      reaches_surface = reaches_surface || is_outer(patch, e, f);
      if (u >= 0 && labels.side[u] != -side) end.push_back(u);
    }
  if (!reaches_surface || end.empty()) return false;
  std::vector<std::uint8_t> is_near(patch.element.size(), 0);
  for (const std::int32_t e : neck)
    for (const std::int32_t i : patch.corner[e])
      for (const std::int32_t u : patch.star(i)) is_near[u] = labels.side[u] != -side ? 1 : 0;
  take_piece(patch, end.front(), is_near);
  return std::ranges::any_of(end, [&](std::int32_t u) { return is_near[u] != 0; });
}

std::vector<std::int32_t> join_necks(const CutSurroundings& around,
                                     std::span<const std::int32_t> decided, CutLabels& labels) {
  std::vector<std::int32_t> joined;
  for (const int side : {1, -1}) {
    std::vector<std::uint8_t> is_wrong = wrong_elements(around, decided, labels, side);
    for (const std::int32_t e : decided) {
      if (is_wrong[e] == 0) continue;
      const std::vector<std::int32_t> neck = take_neck(around, e, side, is_wrong);
      if (!parts_slice(around.patch, labels, side, neck)) continue;
      for (const std::int32_t u : neck) labels.side[u] = static_cast<std::int8_t>(side);
      joined.insert(joined.end(), neck.begin(), neck.end());
    }
  }
  std::ranges::sort(joined);
  return joined;
}

}  // namespace trocar
