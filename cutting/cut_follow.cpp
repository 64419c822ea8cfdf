#include "cutting/cut_follow.h"

#include <algorithm>

#include "base/sort_unique.h"

namespace trocar {

void forget_parted(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke) {
  if (edit.is_empty()) return;
  std::vector<std::int32_t> parted = edit.duplicate_parent;
  sort_unique(parted);
  const auto is_parted = [&](std::int32_t node) {
    return std::ranges::binary_search(parted, node);
  };
  const auto is_opened = [&](std::int32_t e) {
    const auto at = std::ranges::lower_bound(edit.cut_facets, e, {}, &CutFacets::element);
    return at != edit.cut_facets.end() && at->element == e && at->mask != mesh.cut_facets[e];
  };
  const auto is_gone = [&](const CutHit& hit) {
    const std::array<int, 2>& end = tet_edges[hit.edge];
    const auto corner = mesh.corners(hit.element);
    return is_parted(corner[end[0]]) || is_parted(corner[end[1]]) || is_opened(hit.element);
  };
  for (const CutHit& hit : stroke.hit)
    if (is_gone(hit)) stroke.in_slit.push_back(hit.element);
  std::erase_if(stroke.hit, is_gone);
  std::erase_if(stroke.left.hit, is_gone);
  sort_unique(stroke.in_slit);
}

}  // namespace trocar
