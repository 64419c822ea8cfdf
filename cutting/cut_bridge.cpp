#include "cutting/cut_bridge.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/sort_unique.h"
#include "mesh/connected_nodes.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr std::size_t longest_rim = 5;  // nodes: a longer one is the end of a slit as a rule
constexpr double least_hanging = 4;     // mean edges cubed

struct LipFacet {
  FacetNodes uncut;  // ascending: both lips have the same
  FacetNodes node;
};

std::vector<LipFacet> lip_facets(const Mesh& mesh) {
  std::vector<LipFacet> facets;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; mesh.cut_facets[e] >> f != 0; ++f) {
      if ((mesh.cut_facets[e] >> f & 1) == 0) continue;
      LipFacet facet;
      facet.uncut.fill(-1);
      facet.node.fill(-1);
      const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
      for (std::size_t k = 0; k < 4; ++k)
        if (corner[k] >= 0) {
          facet.node[k] = mesh.corners(e)[corner[k]];
          facet.uncut[k] = mesh.uncut_node(facet.node[k]);
        }
      std::ranges::sort(facet.uncut);
      facets.push_back(facet);
    }
  std::ranges::sort(facets, {}, &LipFacet::uncut);
  return facets;
}

// Nodes that the lips of a facet share, with those of facets beside it.
std::vector<std::vector<std::int32_t>> find_rims(const Mesh& mesh) {
  const std::vector<LipFacet> facets = lip_facets(mesh);
  std::vector<std::array<std::int32_t, 2>> beside;
  for (std::size_t k = 1; k < facets.size(); ++k) {
    if (facets[k].uncut != facets[k - 1].uncut) continue;
    std::int32_t first = -1;
    for (const std::int32_t i : facets[k].node) {
      if (i < 0 || std::ranges::find(facets[k - 1].node, i) == facets[k - 1].node.end()) continue;
      if (first < 0) first = i;
      beside.push_back({first, i});
    }
  }
  std::vector<std::int32_t> node;
  for (const auto& [a, b] : beside) node.push_back(b);
  sort_unique(node);
  std::vector<std::size_t> group(node.size());
  std::iota(group.begin(), group.end(), 0);
  for (const auto& [a, b] : beside) {
    const std::size_t from = group[place_in(node, a)], to = group[place_in(node, b)];
    if (from != to) std::ranges::replace(group, std::max(from, to), std::min(from, to));
  }
  std::vector<std::vector<std::int32_t>> rims(node.size());
  for (std::size_t k = 0; k < node.size(); ++k) rims[group[k]].push_back(node[k]);
  std::erase_if(rims, [](const auto& rim) { return rim.empty(); });
  return rims;
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

}  // namespace

std::vector<CutBridge> find_bridges(const Mesh& mesh, double mean_edge) {
  std::vector<std::vector<std::int32_t>> rims = find_rims(mesh);
  std::erase_if(rims, [](const auto& rim) { return rim.size() > longest_rim; });
  if (rims.empty()) return {};
  std::vector<std::int32_t> rim_of(mesh.X.size(), -1);
  for (std::size_t r = 0; r < rims.size(); ++r)
    for (const std::int32_t i : rims[r]) rim_of[i] = static_cast<std::int32_t>(r);
  const Rest rest = without_rims(mesh, rim_of);
  std::vector<std::pair<std::int32_t, std::int32_t>> meets;  // a rim and a large part
  for (const std::int32_t e : rest.removed)
    for (const std::int32_t at : mesh.corners(e))
      for (const std::int32_t i : mesh.corners(e))
        if (rim_of[at] >= 0 && rest.volume[rest.part[i]] > least_hanging * std::pow(mean_edge, 3))
          meets.emplace_back(rim_of[at], rest.part[i]);
  sort_unique(meets);
  std::vector<CutBridge> bridges;
  for (std::size_t k = 0, next = 0; k < meets.size(); k = next) {
    CutBridge bridge{.volume = rest.volume[meets[k].second]};
    for (next = k; next < meets.size() && meets[next].first == meets[k].first; ++next)
      bridge.volume = std::min(bridge.volume, rest.volume[meets[next].second]);
    if (next - k < 2) continue;
    const std::vector<std::int32_t>& rim = rims[meets[k].first];
    for (const std::int32_t i : rim) bridge.X += mesh.X[i] / static_cast<double>(rim.size());
    bridges.push_back(bridge);
  }
  return bridges;
}

}  // namespace trocar
