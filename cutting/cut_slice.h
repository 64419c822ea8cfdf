// Slices of the body no thicker than an element. All their elements are crossed, so that no uncut
// one speaks for their side in the minimum cut: they stayed with the other side, or fell to pieces
// where single uncut elements did.
#pragma once

#include <cstdint>

#include "cutting/cut_label.h"

namespace trocar {

// Slices thinner than this (over h) may stay with the other side.
inline constexpr double thinnest_slice = 0.35;

// Side of the slice under f, an outer facet of an element e whose side is to be decided: the one
// that f lies on, clear of the swept surface. 0 where other elements speak for that side, and where
// this stroke opened f.
int slice_side(const CutSurroundings& around, const CutStroke& stroke, const CutLabels& labels,
               std::int32_t e, int f);

}  // namespace trocar
