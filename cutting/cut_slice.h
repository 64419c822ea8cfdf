// Slices of the body no thicker than an element. All their elements are crossed, so that no uncut
// one speaks for their side in the minimum cut: they stayed with the other side, or fell to pieces
// where single uncut elements did.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_label.h"

namespace trocar {

// Slices thinner than this (over h) may stay with the other side.
inline constexpr double thinnest_slice = 0.35;

// A node clear of the swept surface whose elements all got the other side is lost. Its elements
// among `decided` by the minimum cut (ascending) get its side, those of the deepest node first,
// unless a node as deep is lost on the other side then. Not around `parted` nodes, which this
// stroke has put on either side of what it opened (global, ascending). Returns these elements,
// ascending; the cut is to be decided again with them.
std::vector<std::int32_t> join_slices(const CutSurroundings& around,
                                      std::span<const std::int32_t> parted,
                                      std::span<const std::int32_t> decided, CutLabels& labels);

}  // namespace trocar
