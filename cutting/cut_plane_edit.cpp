#include "cutting/cut_plane_edit.h"

#include <algorithm>
#include <cmath>

#include "cutting/cut_duplicate.h"

namespace trocar {

namespace {

constexpr double inside_tolerance = 1e-12;
constexpr double mass_tolerance = 1e-14;  // rounding of the sums
constexpr std::size_t max_visited = 120;  // elements, some four rings

std::array<double, 3> barycentric(const PlanePatch& patch, int e, const Vec2& p) {
  const auto& [a, b, c] = patch.corner[e];
  const double A = patch.area[e];
  const double w1 = triangle_area(patch.X[a], p, patch.X[c]) / A;
  const double w2 = triangle_area(patch.X[a], patch.X[b], p) / A;
  return {1 - w1 - w2, w1, w2};
}

bool is_moved(const PlanePatch& patch, int i) {
  return patch.x[i] != patch.X[i];
}

void add_moves(const Mesh& mesh, const PlanePatch& before, const PlanePatch& after,
               MeshEdit& edit) {
  for (int i = 0; i < after.n_nodes(); ++i) {
    if (!is_moved(after, i)) continue;
    const Host host = find_host(before, i, after.x[i]);
    NodeMove move{after.node[i],
                  Vec3(after.x[i].x(), after.x[i].y(), mesh.X[after.node[i]].z()),
                  after.element[host.element],
                  {}};
    std::copy(host.weight.begin(), host.weight.end(), move.weight.begin());
    edit.moves.push_back(move);
  }
}

// The elements around the nodes of the cut, with their flips, as a mesh that knows topology only.
struct CutStars {
  std::vector<int> element;  // of the patch, ascending
  Mesh mesh;
  FacetNeighbours across;
};

CutStars cut_stars(const PlanePatch& patch, std::span<const int> nodes) {
  std::vector<int> place(patch.element.size(), -1);
  for (const int i : nodes)
    visit_star(patch, i, [&](int e, int) {
      place[e] = 0;
      return true;
    });
  CutStars stars;
  for (int e = 0; e < patch.n_elements(); ++e) {
    if (place[e] < 0) continue;
    place[e] = static_cast<int>(stars.element.size());
    stars.element.push_back(e);
  }
  stars.mesh.X.resize(patch.node.size());
  for (const int e : stars.element) {
    add_element(stars.mesh, ElementType::tri3, patch.corner[e]);
    stars.mesh.cut_facets.back() = patch.opened[e];
    stars.across.offset.push_back(static_cast<std::int32_t>(stars.across.neighbour.size()));
    for (const int g : patch.across[e]) stars.across.neighbour.push_back(g >= 0 ? place[g] : -1);
  }
  stars.across.offset.push_back(static_cast<std::int32_t>(stars.across.neighbour.size()));
  return stars;
}

Duplication duplicate(const PlanePatch& patch, std::span<const CutChain> chains) {
  std::vector<std::int32_t> nodes;
  for (const CutChain& chain : chains)
    nodes.insert(nodes.end(), chain.node.begin(), chain.node.end());
  const CutStars stars = cut_stars(patch, nodes);
  std::vector<std::array<std::int32_t, 2>> opened;
  for (int k = 0; k < stars.mesh.n_elements(); ++k)
    for (int f = 0; f < 3; ++f)
      if ((patch.chain[stars.element[k]] >> f & 1) != 0) opened.push_back({k, f});
  Duplication result =
      duplicate_nodes(stars.mesh, opened, nodes, node_elements(stars.mesh), stars.across);
  for (CornerChange& change : result.corners) change.element = stars.element[change.element];
  return result;
}

// Corners after flips and duplication where they differ from the mesh.
void add_corners(const Mesh& mesh, const PlanePatch& patch, const Duplication& duplication,
                 MeshEdit& edit) {
  std::vector<std::array<std::int32_t, 3>> corner(patch.element.size());
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int a = 0; a < 3; ++a) corner[e][a] = patch.node[patch.corner[e][a]];
  for (const CornerChange& change : duplication.corners)
    corner[change.element][change.corner] = change.node - patch.n_nodes() + mesh.n_nodes();
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int a = 0; a < 3; ++a)
      if (corner[e][a] != mesh.corners(patch.element[e])[a])
        edit.corners.push_back({patch.element[e], a, corner[e][a]});
  for (const std::int32_t parent : duplication.duplicate_parent)
    edit.duplicate_parent.push_back(patch.node[parent]);
}

void add_masks(const Mesh& mesh, const PlanePatch& patch, MeshEdit& edit) {
  for (int e = 0; e < patch.n_elements(); ++e) {
    const auto mask = static_cast<std::uint8_t>(patch.opened[e] | patch.chain[e]);
    if (mask != mesh.cut_facets[patch.element[e]])
      edit.cut_facets.push_back({patch.element[e], mask});
  }
}

void add_density(const Mesh& mesh, const PlanePatch& after, MeshEdit& edit) {
  std::vector<Reshaped> reshaped;
  for (int e = 0; e < after.n_elements(); ++e)
    if (const double A = area(after, e); A != after.area[e])
      reshaped.push_back({after.element[e], after.region[e], mesh.density_factor[after.element[e]],
                          after.area[e], A});
  edit.density = keep_masses(reshaped, mesh.region_name.size(), mass_tolerance);
}

void measure_deviation(const PlanePatch& patch, std::span<const CutChain> chains,
                       CutFigures& figures) {
  for (const CutChain& chain : chains) {
    figures.n_opened_facets += chain.n_segments();
    for (const int i : chain.node) {
      const double deviation = distance_to(chain.asked, patch.x[i]);
      figures.largest_deviation = std::max(figures.largest_deviation, deviation);
      figures.deviation_sum += deviation;
      ++figures.n_on_cut;
    }
  }
}

}  // namespace

// Takes element e if p is farther inside; true if p is inside.
static bool try_host(const PlanePatch& patch, int e, const Vec2& p, double& best_inside,
                     Host& best) {
  const std::array<double, 3> weight = barycentric(patch, e, p);
  const double inside = std::min({weight[0], weight[1], weight[2]});
  if (inside > best_inside) {
    best_inside = inside;
    best = {e, weight};
  }
  return inside >= -inside_tolerance;
}

Host find_host(const PlanePatch& patch, int node, const Vec2& p) {
  Host best;
  double best_inside = -std::numeric_limits<double>::max();
  std::array<int, max_visited> visited;
  std::size_t n = 0;
  bool is_found = false;
  visit_star(patch, node, [&](int e, int) {
    visited[n++] = e;
    is_found = try_host(patch, e, p, best_inside, best);
    return !is_found && n < max_visited;
  });
  const std::size_t n_star = n;
  for (std::size_t k = 0; k < n && !is_found; ++k) {
    if (k >= n_star && try_host(patch, visited[k], p, best_inside, best)) break;
    const auto end = visited.begin() + static_cast<std::ptrdiff_t>(n);
    for (const int g : patch.across[visited[k]])
      if (g >= 0 && n < max_visited && std::find(visited.begin(), end, g) == end) visited[n++] = g;
  }
  return best;
}

PlaneCut make_plane_cut(const Mesh& mesh, const PlanePatch& before, const PlanePatch& after,
                        std::span<const CutChain> chains) {
  PlaneCut cut;
  const Duplication duplication = duplicate(after, chains);
  add_moves(mesh, before, after, cut.edit);
  add_corners(mesh, after, duplication, cut.edit);
  add_masks(mesh, after, cut.edit);
  add_density(mesh, after, cut.edit);
  cut.figures.n_moved = static_cast<std::int32_t>(cut.edit.moves.size());
  cut.figures.n_duplicated = static_cast<std::int32_t>(cut.edit.duplicate_parent.size());
  for (int e = 0; e < after.n_elements(); ++e)
    if (area(after, e) != before.area[e] || after.corner[e] != before.corner[e])
      cut.figures.least_quality = std::min(cut.figures.least_quality, quality(after, e));
  measure_deviation(after, chains, cut.figures);
  cut.figures.mean_edge = after.h;
  const CutChain& last = chains.back();
  if (last.path.end_on.element < 0) cut.tip = after.node[last.node.back()];
  return cut;
}

}  // namespace trocar
