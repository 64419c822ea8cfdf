// Local to global numbers, mass, and the stroke's memory.
#include "cutting/cut_edit.h"

#include <algorithm>
#include <cmath>

#include "base/sort_unique.h"
#include "cutting/cut_follow.h"
#include "mesh/quality.h"

namespace trocar {

// A node of an opened facet this near to the surface (over h) has no side.
static constexpr double neutral_distance = 0.05;

// A parted node this far from the surface (over h) lies beside it.
static constexpr double beside_distance = 0.1;

static std::vector<std::int32_t> moved_elements(const TetCut& cut) {
  return elements_around(cut.around.patch, cut.transfer);
}

static std::vector<DensityChange> density_changes(const Mesh& mesh, const TetCut& cut) {
  const CutPatch& patch = cut.around.patch;
  std::vector<Reshaped> reshaped;
  for (const std::int32_t e : moved_elements(cut)) {
    const std::int32_t global = patch.element[e];
    reshaped.push_back({global, mesh.element_region[global], mesh.density_factor[global],
                        six_volumes(patch.X, patch.corner[e]),
                        six_volumes(cut.X, patch.corner[e])});
  }
  return keep_masses(reshaped, mesh.region_name.size());
}

// Facets that are apart after the edit, by global element.
static std::vector<OfElement<std::uint8_t>> opened_facets(const TetCut& cut) {
  std::vector<OfElement<std::uint8_t>> opened;
  for (const auto& [e, f] : cut.opening.facet) {
    if (is_joined(cut.around.patch, cut.opening.corner, e, f)) continue;
    const std::int32_t element = cut.around.patch.element[e];
    if (opened.empty() || opened.back().element != element) opened.push_back({element, 0});
    opened.back().value = static_cast<std::uint8_t>(opened.back().value | 1U << f);
  }
  return opened;
}

MeshEdit make_edit(const Mesh& mesh, const TetCut& cut) {
  const CutPatch& patch = cut.around.patch;
  MeshEdit edit;
  for (const NodeTransfer& t : cut.transfer) {
    NodeMove move{patch.node[t.node], cut.X[t.node], patch.element[t.host], {}};
    std::copy(t.weight.begin(), t.weight.end(), move.weight.begin());
    edit.moves.push_back(move);
  }
  for (const std::int32_t parent : cut.opening.duplication.duplicate_parent)
    edit.duplicate_parent.push_back(patch.node[parent]);
  for (const CornerChange& c : cut.opening.duplication.corners)
    edit.corners.push_back(
        {patch.element[c.element], c.corner, mesh.n_nodes() + (c.node - patch.n_nodes())});
  for (const auto& [element, mask] : opened_facets(cut))
    edit.cut_facets.push_back(
        {element, static_cast<std::uint8_t>(mesh.cut_facets[element] | mask)});
  edit.density = density_changes(mesh, cut);
  return edit;
}

// Of the elements whose shape or corners change; a copy of a node lies where its parent does.
static double least_quality(const TetCut& cut) {
  const CutPatch& patch = cut.around.patch;
  std::vector<std::int32_t> element = moved_elements(cut);
  for (const CornerChange& change : cut.opening.duplication.corners)
    element.push_back(change.element);
  sort_unique(element);
  double least = 1;
  for (const std::int32_t e : element) {
    const auto& [a, b, c, d] = patch.corner[e];
    const std::array<Vec3, 4> X = {cut.X[a], cut.X[b], cut.X[c], cut.X[d]};
    least = std::min(least, element_quality(ElementType::tet4, X));
  }
  return least;
}

static std::vector<CutRefusal> refusals(const TetCut& cut, bool is_last) {
  std::vector<CutRefusal> list;
  for (const CutChip& chip : cut.chips) list.push_back({chip.centre, CutRefusal::chip});
  if (!is_last) return list;
  for (const auto& [e, f] : cut.opening.refused) {
    const std::array<std::int32_t, 3> node = facet_nodes(cut.around.patch, e, f);
    const bool is_bent =
        std::ranges::any_of(node, [&](std::int32_t i) { return cut.around.patch.is_bent[i] != 0; });
    list.push_back({(cut.X[node[0]] + cut.X[node[1]] + cut.X[node[2]]) / 3,
                    is_bent ? CutRefusal::bent : CutRefusal::pinched});
  }
  return list;
}

CutFigures make_figures(const TetCut& cut, bool is_last) {
  CutFigures figures;
  const CutPatch& patch = cut.around.patch;
  for (const auto& [e, f] : cut.opening.facet)
    if (patch.across[e][f] > e && !is_joined(patch, cut.opening.corner, e, f))
      ++figures.n_opened_facets;
  figures.n_moved = static_cast<std::int32_t>(cut.transfer.size());
  const std::vector<std::int32_t>& parent = cut.opening.duplication.duplicate_parent;
  figures.n_duplicated = static_cast<std::int32_t>(parent.size());
  figures.refusals = refusals(cut, is_last);
  figures.n_refused = static_cast<std::int32_t>(figures.refusals.size());
  figures.least_quality = least_quality(cut);
  for (const std::int32_t i : parent) {
    const double distance = surface_distance(cut.around, i, cut.X[i]);
    figures.largest_deviation = std::max(figures.largest_deviation, distance);
    figures.n_beside += distance > beside_distance * cut.around.h ? 1 : 0;
    figures.deviation_sum += distance;
  }
  figures.n_on_cut = figures.n_duplicated;
  figures.n_turned = cut.rungs.n_turned;
  figures.n_chips = static_cast<std::int32_t>(cut.chips.size());
  figures.n_pulled_back = cut.rungs.n_pulled_back;
  figures.n_inverted = cut.rungs.n_inverted;
  figures.mean_edge = cut.around.h;
  return figures;
}

// Sides are kept where something is open: there they can't be taken back. So are those of chips:
// measured by the mean edge around the blade, one may be none when the blade is elsewhere.
// Elsewhere the next edit knows more.
static void remember_sides(const TetCut& cut, CutStroke& stroke) {
  const CutPatch& patch = cut.around.patch;
  std::vector<std::uint8_t> is_kept(patch.element.size(), 0);
  for (const auto& [e, f] : cut.opening.facet) is_kept[e] = 1;
  for (const CutChip& chip : cut.chips)
    for (const std::int32_t e : chip.element) is_kept[e] = 1;
  std::vector<OfElement<std::int8_t>> side;
  const std::vector<std::span<const CutHit>> hits = hits_of(stroke, patch.element);
  for (std::int32_t e = 0; e < patch.n_elements(); ++e) {
    if (cut.labels.kind[e] == CutKind::front && hits[e].empty())
      stroke.unfinished.push_back(patch.element[e]);
    if (cut.labels.side[e] == 0 || cut.labels.kind[e] == CutKind::front) continue;
    const auto& corner = patch.corner[e];
    const bool is_at_opening = std::any_of(corner.begin(), corner.end(),
                                           [&](std::int32_t i) { return cut.is_cut[i] != 0; });
    if (is_kept[e] != 0 || (cut.labels.kind[e] == CutKind::separated && is_at_opening))
      side.push_back({patch.element[e], cut.labels.side[e]});
    else if (cut.labels.kind[e] == CutKind::separated)
      stroke.unfinished.push_back(patch.element[e]);
  }
  merge_elements(stroke.side, side);
  for (const CutChip& chip : cut.chips) merge_elements(stroke.side, chip.beyond);
}

static void remember_nodes(const TetCut& cut, std::int32_t n_nodes, CutStroke& stroke) {
  const CutPatch& patch = cut.around.patch;
  const std::vector<std::int32_t>& parent = cut.opening.duplication.duplicate_parent;
  std::vector<std::uint8_t> is_neutral(patch.node.size(), 0);
  std::erase_if(stroke.surface_node, [&](std::int32_t node) {
    const std::int32_t i = patch.local_node(node);
    return i >= 0 && patch.is_whole(i);
  });
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i) {
    if (!patch.is_whole(i) || cut.is_cut[i] == 0 || cut.around.points.of(i).empty()) continue;
    if (surface_distance(cut.around, i, cut.X[i]) > neutral_distance * cut.around.h) continue;
    is_neutral[i] = 1;
    stroke.surface_node.push_back(patch.node[i]);
  }
  for (std::size_t k = 0; k < parent.size(); ++k) {
    const std::int32_t copy = n_nodes + static_cast<std::int32_t>(k);
    stroke.parted_node.push_back(patch.node[parent[k]]);
    stroke.parted_node.push_back(copy);
    if (is_neutral[parent[k]] != 0) stroke.surface_node.push_back(copy);
  }
  sort_unique(stroke.surface_node);
  sort_unique(stroke.parted_node);
}

static void remember_steps(const TetCut& cut, const Mesh& mesh, CutStroke& stroke) {
  std::vector<std::int32_t> moved;
  for (const std::int32_t e : moved_elements(cut)) moved.push_back(cut.around.patch.element[e]);
  keep_steps(mesh, moved, stroke);
}

void remember(const TetCut& cut, const Mesh& mesh, CutStroke& stroke) {
  const CutPatch& patch = cut.around.patch;
  stroke.swept = 0;
  stroke.fresh.clear();
  stroke.unfinished.clear();
  for (const auto& [e, f] : cut.opening.refused) {
    stroke.unfinished.push_back(patch.element[e]);
    stroke.unfinished.push_back(patch.element[patch.across[e][f]]);
  }
  remember_sides(cut, stroke);
  sort_unique(stroke.unfinished);
  remember_nodes(cut, mesh.n_nodes(), stroke);
  remember_steps(cut, mesh, stroke);
  std::vector<OfElement<std::uint8_t>> opened = opened_facets(cut);
  for (OfElement<std::uint8_t>& entry : opened)
    if (const std::uint8_t* before = find_element(stroke.opened, entry.element))
      entry.value = static_cast<std::uint8_t>(entry.value | *before);
  merge_elements(stroke.opened, opened);
}

}  // namespace trocar
