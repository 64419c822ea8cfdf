// Necks of slices. Where a slice is hardly thicker than an element, the minimum cut may find it
// cheaper to cross it twice than to pass under it: a part stays with the other side, and what lies
// around it comes off in pieces that no blade parted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_label.h"

namespace trocar {

// Elements of `decided` by the minimum cut (ascending) that lie on one side, have a corner clear of
// the surface there, and part what is left of that side around them: they get that side. Returns
// them, ascending; the cut is to be decided again with these.
std::vector<std::int32_t> join_necks(const CutSurroundings& around,
                                     std::span<const std::int32_t> decided, CutLabels& labels);

}  // namespace trocar
