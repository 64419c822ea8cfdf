// Pieces of the patch by flooding across the facets that stay joined.
#include "cutting/cut_chips.h"

#include <algorithm>

namespace trocar {

// A piece with less volume than this part of the mean edge cubed is a chip.
static constexpr double chip_volume = 0.5;

// The elements that hang together with `first` after the opening; marks them.
static std::vector<std::int32_t> piece_of(const CutPatch& patch, const CutOpening& opening,
                                          std::int32_t first, std::vector<std::uint8_t>& is_seen) {
  std::vector<std::int32_t> piece{first};
  is_seen[first] = 1;
  for (std::size_t k = 0; k < piece.size(); ++k)
    for (int f = 0; f < 4; ++f) {
      const std::int32_t u = patch.across[piece[k]][f];
      if (u < 0 || is_seen[u] != 0 || !is_joined(patch, opening.corner, piece[k], f)) continue;
      is_seen[u] = 1;
      piece.push_back(u);
    }
  return piece;
}

// Whether all of the piece is in the patch, and small.
static bool is_chip(const CutSurroundings& around, const std::vector<std::int32_t>& piece) {
  double six_V = 0;
  for (const std::int32_t e : piece) {
    const auto& corner = around.patch.corner[e];
    if (!std::all_of(corner.begin(), corner.end(), [&](std::int32_t i) {
          return around.patch.is_whole(i) && around.patch.is_locked[i] == 0;
        }))
      return false;
    six_V += six_volumes(around.patch.X, corner);
  }
  return six_V < 6 * chip_volume * around.h * around.h * around.h;
}

std::vector<CutChip> attach_chips(const CutSurroundings& around, const CutOpening& opening,
                                  CutLabels& labels) {
  std::vector<CutChip> chips;
  if (opening.duplication.duplicate_parent.empty()) return chips;
  std::vector<std::uint8_t> is_seen(around.patch.element.size(), 0);
  for (const auto& [first, f] : opening.facet) {
    if (is_seen[first] != 0) continue;
    std::vector<std::int32_t> piece = piece_of(around.patch, opening, first, is_seen);
    if (!is_chip(around, piece)) continue;
    for (const std::int32_t e : piece) labels.side[e] = static_cast<std::int8_t>(-labels.side[e]);
    chips.push_back({centre_of(around.patch, piece), std::move(piece)});
  }
  return chips;
}

}  // namespace trocar
