// Gathering the patch around a stroke's front, and the roles of its nodes.
#include "cutting/cut_survey.h"

#include <algorithm>

#include "base/sort_unique.h"

namespace trocar {

// Squared distance over h, in place of it, of a node that would have to move and can't.
static constexpr double immovable_cost = 30;
// Of one between two regions, if less, this times its squared distance: the cut opens the interface
// where that lies nearer to the blade (0.27 h) than others can come.
static constexpr double interface_cost = 5;
// A node that can't move may lie this far from the surface (over h) without counting as off it.
static constexpr double tolerated_distance = 0.1;

// To put a node on the surface for the look only, elements may sink to this part of the median step
// bound around, or to that of the floor if it is lower, and none below the least one: a grid keeps
// 0.75 of its step, an organ's mesh all.
static constexpr double part_of_typical = 0.75;

static std::vector<std::int32_t> seed_elements(const CutStroke& stroke, bool is_last) {
  std::vector<std::int32_t> seed = stroke.fresh;
  seed.insert(seed.end(), stroke.unfinished.begin(), stroke.unfinished.end());
  if (is_last)
    for (const CutHit& hit : stroke.hit)
      if (find_element(stroke.side, hit.element) == nullptr) seed.push_back(hit.element);
  sort_unique(seed);
  return seed;
}

// Adds distance and cost of node i.
static void add_distance(CutSurroundings& around, std::int32_t i) {
  const std::span<const SurfacePoint> points = around.points.of(i);
  around.distance.push_back(0);
  around.surface_cost.push_back(0);
  if (points.empty()) return;
  const SurfacePlane plane = fit_surface(points, around.patch.X[i], around.h);
  around.distance[i] = plane.distance(around.patch.X[i]);
  const double distance = around.distance[i] / around.h, d2 = distance * distance;
  const double slope2 = allowed_part(around.boundary[i], plane.N).squaredNorm();
  const double most = around.boundary[i].is_interface
                          ? std::min(interface_cost * d2, immovable_cost)
                          : immovable_cost;
  around.surface_cost[i] = d2 <= tolerated_distance * tolerated_distance
                               ? d2
                               : std::min(d2 / std::max(slope2, 1e-6), most);
}

static void lock_bent(const HexTets& hexahedra, PresentPositions& positions, CutPatch& patch) {
  for (const std::int32_t node : bent_nodes(hexahedra, positions, patch.element))
    if (const std::int32_t i = patch.local_node(node); i >= 0)
      patch.is_bent[i] = patch.is_locked[i] = 1;
}

CutSurroundings survey(const Mesh& mesh, const HexTets* hexahedra, CutIndex& index,
                       PresentPositions& positions, const CutConstraints& constraints,
                       const CutStroke& stroke, bool is_last) {
  CutSurroundings around;
  around.h = stroke.mean_edge;
  const std::vector<std::int32_t> seed = seed_elements(stroke, is_last);
  if (seed.empty()) return around;
  around.patch = make_patch(mesh, index, positions, constraints, seed);
  if (hexahedra != nullptr) lock_bent(*hexahedra, positions, around.patch);
  around.points = surface_points(around.patch, stroke);
  for (std::int32_t i = 0; i < around.patch.n_nodes(); ++i) {
    NodeBoundary boundary;
    boundary.freedom = NodeFreedom::fixed;
    if (around.patch.node_ring[i] <= 1)
      boundary = node_boundary(around.patch, stroke, mesh.cut_facets, i);
    around.boundary.push_back(std::move(boundary));
    add_distance(around, i);
  }
  return around;
}

static void mark_cut_nodes(TetCut& cut, const CutStroke& stroke) {
  const CutPatch& patch = cut.around.patch;
  cut.is_cut.assign(patch.node.size(), 0);
  for (const auto& [e, f] : cut.opening.facet)
    for (const std::int32_t i : facet_nodes(patch, e, f)) cut.is_cut[i] = 1;
  const std::vector<const std::uint8_t*> opened = find_elements(stroke.opened, patch.element);
  for (std::int32_t e = 0; e < patch.n_elements(); ++e) {
    for (int f = 0; opened[e] != nullptr && f < 4; ++f)
      if ((*opened[e] >> f & 1) != 0)
        for (const std::int32_t i : facet_nodes(patch, e, f)) cut.is_cut[i] = 1;
  }
}

void set_roles(TetCut& cut, const CutStroke& stroke, bool is_last) {
  const CutPatch& patch = cut.around.patch;
  mark_cut_nodes(cut, stroke);
  const auto may_move = [&](std::int32_t i) {
    return (is_last || cut.labels.is_front_node[i] == 0) && patch.node_ring[i] <= 1 &&
           !std::binary_search(stroke.parted_node.begin(), stroke.parted_node.end(), patch.node[i]);
  };
  cut.role.assign(patch.node.size(), NodeRole::stays);
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i)
    if (cut.is_cut[i] != 0 && may_move(i)) cut.role[i] = NodeRole::on_surface;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e) {
    const auto& corner = patch.corner[e];
    if (std::none_of(corner.begin(), corner.end(),
                     [&](std::int32_t i) { return cut.role[i] == NodeRole::on_surface; }))
      continue;
    for (const std::int32_t i : corner)
      if (cut.role[i] == NodeRole::stays && cut.is_cut[i] == 0 && may_move(i))
        cut.role[i] = NodeRole::makes_room;
  }
}

MoveLimits move_limits(const CutSurroundings& around, const CutStroke& stroke, double part) {
  const CutPatch& patch = around.patch;
  const std::vector<const double*> before = find_elements(stroke.step, patch.element);
  std::vector<double> bound;
  for (std::int32_t e = 0; e < patch.n_elements(); ++e)
    bound.push_back(before[e] != nullptr ? *before[e] : step_bound(patch.X, patch.corner[e]));
  const double least = *std::min_element(bound.begin(), bound.end());
  const auto middle = bound.begin() + std::ssize(bound) / 2;
  std::nth_element(bound.begin(), middle, bound.end());
  const double typical = std::min(part, part_of_typical) * *middle;
  return {part * least, std::max(part * least, std::min(least, typical))};
}

}  // namespace trocar
