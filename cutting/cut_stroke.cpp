// Lookup in a stroke's memory.
#include "cutting/cut_stroke.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "cutting/cut_carry.h"

namespace trocar {

std::array<CutKnown*, 3> all_known(CutStroke& stroke) {
  return {&stroke, &stroke.left, &stroke.beside};
}

static bool is_outside(const CutStroke& stroke) {
  return std::ranges::none_of(stroke.edge, &BladePoint::is_inside);
}

bool has_come_out(const CutStroke& stroke) {
  return !stroke.is_amid && is_outside(stroke);
}

bool has_drawn_back(const CutStroke& stroke) {
  return stroke.is_amid && is_outside(stroke);
}

bool has_gone_through(const CutStroke& stroke) {
  return stroke.rim.empty() && has_come_out(stroke);
}

bool is_clear_of_rim(const CutStroke& stroke, const Vec3& X, double width) {
  const double reach = width * stroke.mean_edge;
  return std::ranges::none_of(stroke.rim,
                              [&](const Vec3& R) { return (R - X).squaredNorm() < reach * reach; });
}

bool goes_on(const CutStroke& stroke) {
  return std::ranges::any_of(stroke.edge, [&](const BladePoint& p) {
    return p.ahead.dot(p.farthest) <= same_place * stroke.mean_edge;
  });
}

void sort_hits(std::vector<CutHit>& hits) {
  sort_unique_by(hits, &CutHit::key);
}

std::span<const CutHit> hits_of(const CutStroke& stroke, std::int32_t element) {
  return std::ranges::equal_range(stroke.hit, element, {}, &CutHit::element);
}

std::vector<std::span<const CutHit>> hits_of(const CutStroke& stroke,
                                             std::span<const std::int32_t> element) {
  std::vector<std::span<const CutHit>> hits(element.size());
  if (element.empty()) return hits;
  auto at = std::lower_bound(stroke.hit.begin(), stroke.hit.end(), element[0],
                             [](const CutHit& hit, std::int32_t e) { return hit.element < e; });
  for (std::size_t k = 0; k < element.size(); ++k) {
    while (at != stroke.hit.end() && at->element < element[k]) ++at;
    const auto begin = at;
    while (at != stroke.hit.end() && at->element == element[k]) ++at;
    hits[k] = {begin, at};
  }
  return hits;
}

}  // namespace trocar
