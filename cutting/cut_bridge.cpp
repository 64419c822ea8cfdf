#include "cutting/cut_bridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/disjoint_sets.h"
#include "base/sort_unique.h"
#include "mesh/connected_nodes.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr std::int32_t longest_rim = 5;  // nodes
constexpr double least_hanging = 4;      // mean edges cubed
constexpr double strip = 4;              // mean edges from rim to rim

using LipNodes = std::array<std::int32_t, 3>;

struct LipTriangle {
  LipNodes uncut;  // ascending: both lips have the same
  LipNodes node;
};

// Of opened facets, quads by any three of their corners: tetrahedra may lie across.
std::vector<LipTriangle> lip_triangles(const Mesh& mesh) {
  std::vector<LipTriangle> triangles;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; mesh.cut_facets[e] >> f != 0; ++f) {
      if ((mesh.cut_facets[e] >> f & 1) == 0) continue;
      const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
      for (std::size_t without = corner[3] < 0 ? 3 : 0; without < 4; ++without) {
        LipTriangle lip;
        for (std::size_t k = 0; k < 3; ++k) {
          lip.node[k] = mesh.corners(e)[corner[k < without ? k : k + 1]];
          lip.uncut[k] = mesh.uncut_node(lip.node[k]);
        }
        std::ranges::sort(lip.uncut);
        triangles.push_back(lip);
      }
    }
  std::ranges::sort(triangles, {}, &LipTriangle::uncut);
  return triangles;
}

// Nodes that both lips of a facet share, and the rim of each: those of one facet are beside each
// other.
struct Rims {
  std::vector<std::int32_t> node;  // ascending
  std::vector<std::int32_t> of;    // (node.size()) position of the rim's first node
};

Rims find_rims(const Mesh& mesh) {
  const std::vector<LipTriangle> lips = lip_triangles(mesh);
  std::vector<std::array<std::int32_t, 2>> beside;
  for (std::size_t k = 1; k < lips.size(); ++k) {
    if (lips[k].uncut != lips[k - 1].uncut) continue;
    std::int32_t first = -1;
    for (const std::int32_t i : lips[k].node) {
      if (std::ranges::find(lips[k - 1].node, i) == lips[k - 1].node.end()) continue;
      if (first < 0) first = i;
      beside.push_back({first, i});
    }
  }
  Rims rims;
  for (const auto& [a, b] : beside) rims.node.push_back(b);
  sort_unique(rims.node);
  DisjointSets sets(rims.node.size());
  for (const auto& [a, b] : beside) sets.join(place_in(rims.node, a), place_in(rims.node, b));
  rims.of = std::move(sets).roots();
  return rims;
}

// (n_nodes) The short rim that a node is of, -1: none.
std::vector<std::int32_t> short_rims(const Mesh& mesh) {
  const Rims rims = find_rims(mesh);
  std::vector<std::int32_t> n_nodes(rims.node.size()), rim_of(mesh.X.size(), -1);
  for (const std::int32_t rim : rims.of) ++n_nodes[rim];
  for (std::size_t k = 0; k < rims.node.size(); ++k)
    if (n_nodes[rims.of[k]] <= longest_rim) rim_of[rims.node[k]] = rims.of[k];
  return rim_of;
}

// The body without the elements at rims.
struct Rest {
  std::vector<std::int32_t> part;     // (n_nodes) of connected_nodes
  std::vector<double> volume;         // (n_nodes) of the part that the node names [m^3]
  std::vector<std::int32_t> removed;  // elements
};

Rest without_rims(const Mesh& mesh, const std::vector<std::int32_t>& rim_of) {
  Rest rest;
  std::vector<std::int32_t> kept;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const bool is_at_rim =
        std::ranges::any_of(mesh.corners(e), [&](std::int32_t i) { return rim_of[i] >= 0; });
    (is_at_rim ? rest.removed : kept).push_back(e);
  }
  rest.part = connected_nodes(mesh, kept);
  rest.volume.assign(mesh.X.size(), 0);
  for (const std::int32_t e : kept)
    rest.volume[rest.part[mesh.corners(e)[0]]] += element_volume(mesh, e, mesh.X);
  return rest;
}

// An element at a rim that meets a large part of the rest.
struct Meeting {
  std::int32_t rim = 0, part = 0;
  auto operator<=>(const Meeting&) const = default;
};

std::vector<Meeting> find_meetings(const Mesh& mesh, const std::vector<std::int32_t>& rim_of,
                                   const Rest& rest, double least_volume) {
  std::vector<Meeting> meetings;
  for (const std::int32_t e : rest.removed)
    for (const std::int32_t at : mesh.corners(e)) {
      if (rim_of[at] < 0) continue;
      for (const std::int32_t i : mesh.corners(e))
        if (rest.volume[rest.part[i]] > least_volume)
          meetings.push_back({rim_of[at], rest.part[i]});
    }
  sort_unique(meetings);
  return meetings;
}

Vec3 middle_of_rim(const Mesh& mesh, const std::vector<std::int32_t>& rim_of, std::int32_t rim) {
  Vec3 sum = Vec3::Zero();
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (rim_of[i] == rim) sum += mesh.X[i];
  return sum / static_cast<double>(std::ranges::count(rim_of, rim));
}

}  // namespace

std::vector<CutBridge> find_bridges(const Mesh& mesh, double mean_edge) {
  CHECK_OP(mesh.dimension(), ==, 3);
  const std::vector<std::int32_t> rim_of = short_rims(mesh);
  if (std::ranges::all_of(rim_of, [](std::int32_t rim) { return rim < 0; })) return {};
  const Rest rest = without_rims(mesh, rim_of);
  const std::vector<Meeting> meetings =
      find_meetings(mesh, rim_of, rest, least_hanging * std::pow(mean_edge, 3));
  std::vector<CutBridge> bridges;
  for (auto first = meetings.begin(), next = first; first != meetings.end(); first = next) {
    next = std::ranges::upper_bound(first, meetings.end(), first->rim, {}, &Meeting::rim);
    if (next - first < 2) continue;  // the rest hangs together around the rim
    const auto volume_of = [&](const Meeting& m) { return rest.volume[m.part]; };
    const CutBridge bridge{
        .X = middle_of_rim(mesh, rim_of, first->rim),
        .volume = volume_of(*std::ranges::min_element(first, next, {}, volume_of))};
    // A strip between two rims is one.
    if (std::ranges::none_of(bridges, [&](const CutBridge& other) {
          return (other.X - bridge.X).norm() < strip * mean_edge;
        }))
      bridges.push_back(bridge);
  }
  return bridges;
}

}  // namespace trocar
