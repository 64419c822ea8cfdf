// Lookup in a stroke's memory.
#include "cutting/cut_stroke.h"

#include <algorithm>

namespace trocar {

std::span<const CutHit> hits_of(const CutStroke& stroke, std::int32_t element) {
  const auto begin =
      std::lower_bound(stroke.hit.begin(), stroke.hit.end(), element,
                       [](const CutHit& hit, std::int32_t e) { return hit.element < e; });
  auto end = begin;
  while (end != stroke.hit.end() && end->element == element) ++end;
  return {begin, end};
}

}  // namespace trocar
