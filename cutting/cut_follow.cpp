#include "cutting/cut_follow.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "cutting/cut_go_on.h"
#include "cutting/cut_patch.h"

namespace trocar {

void keep_steps(const Mesh& mesh, std::span<const std::int32_t> element, CutStroke& stroke) {
  std::vector<OfElement<double>> step;
  for (const std::int32_t e : element)
    if (mesh.element_type[e] == ElementType::tet4 && find_element(stroke.step, e) == nullptr)
      step.push_back({e, tet_step_bound(mesh, e)});
  merge_elements(stroke.step, step);
}

void keep_steps_around(const Mesh& mesh, const CutIndex& index, const MeshEdit& edit,
                       CutStroke& stroke) {
  keep_steps(mesh, elements_around(index, moved_nodes(edit)), stroke);
}

// Whether the other blade passed along the crossing's surface there.
static bool is_along(std::span<const CutHit> along, const CutHit& hit) {
  constexpr double least_cosine = 0.87;
  if (along.empty()) return true;
  const auto nearest = std::ranges::min_element(
      along, {}, [&](const CutHit& other) { return (other.X - hit.X).squaredNorm(); });
  return std::abs(nearest->N.dot(hit.N)) >= least_cosine;
}

static void add_copies(const Mesh& mesh, const MeshEdit& edit, std::vector<std::int32_t>& nodes) {
  const std::size_t n = nodes.size();
  for (std::size_t k = 0; k < edit.duplicate_parent.size(); ++k)
    if (std::binary_search(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(n),
                           edit.duplicate_parent[k]))
      nodes.push_back(mesh.n_nodes() + static_cast<std::int32_t>(k));
}

void follow_opening(const Mesh& mesh, const MeshEdit& edit, const CutKnown& along,
                    CutStroke& stroke) {
  if (edit.is_empty()) return;
  go_on_beside(mesh, along, stroke);
  std::vector<std::int32_t> parted = edit.duplicate_parent;
  sort_unique(parted);
  const auto is_parted = [&](std::int32_t node) {
    return std::ranges::binary_search(parted, node);
  };
  const auto is_opened = [&](std::int32_t e) {
    return cut_facets_after(edit, mesh, e) != mesh.cut_facets[e];
  };
  const auto is_gone = [&](const CutHit& hit) {
    const std::array<int, 2>& end = tet_edges[hit.edge];
    const auto corner = mesh.corners(hit.element);
    return (is_parted(corner[end[0]]) || is_parted(corner[end[1]]) || is_opened(hit.element)) &&
           is_along(along.hit, hit);
  };
  const auto is_gone_of_own = [&](const CutHit& hit) {
    return is_gone(hit) && find_element(stroke.side, hit.element) == nullptr;
  };
  for (const CutHit& hit : stroke.hit)
    if (is_gone_of_own(hit)) stroke.in_slit.push_back(hit.element);
  std::erase_if(stroke.hit, is_gone_of_own);
  std::erase_if(stroke.left.hit, is_gone);
  sort_unique(stroke.in_slit);
  for (CutKnown* known : all_known(stroke))
    for (auto* nodes : {&known->surface_node, &known->parted_node}) {
      add_copies(mesh, edit, *nodes);
      sort_unique(*nodes);
    }
}

}  // namespace trocar
