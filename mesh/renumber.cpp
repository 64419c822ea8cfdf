#include "mesh/renumber.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/check.h"
#include "base/grouped.h"
#include "mesh/facets.h"
#include "mesh/sub_mesh.h"

namespace trocar {

namespace {

// Nodes that share an edge of the mesh with each node; those with few neighbours first, then the
// lower number.
Grouped<> neighbourhood_of(const Mesh& mesh) {
  const auto edges = mesh_edges(mesh);
  Grouped<> all = group_items(mesh.X.size(), [&](const auto& put) {
    for (const auto& [a, b] : edges) put(a, b), put(b, a);
  });
  const auto by_degree = [&](std::int32_t i) { return std::pair(all.of(i).size(), i); };
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    std::sort(all.item.begin() + all.offset[i], all.item.begin() + all.offset[i + 1],
              [&](std::int32_t a, std::int32_t b) { return by_degree(a) < by_degree(b); });
  return all;
}

// Appends all nodes that hang together with `first` to `order`, breadth first; marks them.
void visit(const Grouped<>& neighbours, std::int32_t first, std::vector<std::uint8_t>& is_seen,
           std::vector<std::int32_t>& order) {
  std::size_t at = order.size();
  order.push_back(first);
  is_seen[first] = 1;
  for (; at < order.size(); ++at)
    for (const std::int32_t i : neighbours.of(order[at]))
      if (std::exchange(is_seen[i], 1) == 0) order.push_back(i);
}

// A node far from the others of its piece: the last one of a search, again and again.
std::int32_t node_at_rim(const Grouped<>& neighbours, std::int32_t first,
                         std::vector<std::uint8_t>& is_seen) {
  constexpr int n_searches = 3;
  std::vector<std::int32_t> order;
  for (int k = 0; k < n_searches; ++k) {
    order.clear();
    visit(neighbours, first, is_seen, order);
    for (const std::int32_t i : order) is_seen[i] = 0;
    first = order.back();
  }
  return first;
}

// Number of the node that comes k-th.
std::vector<std::int32_t> near_order(const Mesh& mesh) {
  const Grouped<> neighbours = neighbourhood_of(mesh);
  std::vector<std::uint8_t> is_seen(mesh.X.size(), 0);
  std::vector<std::int32_t> order;
  order.reserve(mesh.X.size());
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (is_seen[i] == 0) visit(neighbours, node_at_rim(neighbours, i, is_seen), is_seen, order);
  std::reverse(order.begin(), order.end());
  return order;
}

// Ascending by the elements' nodes, lowest first.
std::vector<std::int32_t> element_order(const Mesh& mesh,
                                        std::span<const std::int32_t> new_number) {
  std::vector<std::array<std::int32_t, max_corners>> key(mesh.element_type.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto corners = mesh.corners(e);
    key[e].fill(-1);
    for (std::size_t a = 0; a < corners.size(); ++a) key[e][a] = new_number[corners[a]];
    std::sort(key[e].begin(), key[e].begin() + std::ssize(corners));
  }
  std::vector<std::int32_t> order(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::tie(key[a], a) < std::tie(key[b], b);
  });
  return order;
}

// Everything that belongs to single elements, in this order; new_number: of nodes, which stay.
void take_elements(const Mesh& mesh, std::span<const std::int32_t> order,
                   std::span<const std::int32_t> new_number, Mesh& result) {
  result.element_type = values_of(std::span(mesh.element_type), order);
  result.corner_offset.clear();
  result.corner_node.clear();
  for (const std::int32_t e : order) {
    result.corner_offset.push_back(static_cast<std::int32_t>(result.corner_node.size()));
    for (const std::int32_t i : mesh.corners(e)) result.corner_node.push_back(new_number[i]);
  }
  result.element_region = values_of(std::span(mesh.element_region), order);
  result.density_factor = values_of(std::span(mesh.density_factor), order);
  result.cut_facets = values_of(std::span(mesh.cut_facets), order);
  if (!mesh.fibre.empty()) result.fibre = values_of(std::span(mesh.fibre), order);
}

// The place of each number in the order.
std::vector<std::int32_t> places_in(std::span<const std::int32_t> order) {
  std::vector<std::int32_t> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<std::int32_t>(k);
  return place;
}

}  // namespace

Mesh in_orders(const Mesh& mesh, std::span<const std::int32_t> nodes,
               std::span<const std::int32_t> elements) {
  Mesh result;
  result.X = values_of(std::span(mesh.X), nodes);
  take_elements(mesh, elements, places_in(nodes), result);
  result.region_name = mesh.region_name;
  return result;
}

double mean_node_span(const Mesh& mesh) {
  double sum = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto [low, high] = std::ranges::minmax(mesh.corners(e));
    sum += high - low;
  }
  return sum / std::max(1, mesh.n_elements());
}

Mesh renumbered(const Mesh& mesh) {
  CHECK_OP(mesh.copied_node.size(), ==, 0U);
  CHECK_OP(mesh.hex_split_rank.size(), ==, 0U);
  const std::vector<std::int32_t> nodes = near_order(mesh);
  const std::vector<std::int32_t> new_number = places_in(nodes);
  Mesh result = in_orders(mesh, nodes, element_order(mesh, new_number));
  result.node_sets = mesh.node_sets;
  for (NodeSet& set : result.node_sets) {
    for (std::int32_t& i : set.node) i = new_number[i];
    std::sort(set.node.begin(), set.node.end());
    for (FacetNodes& facet : set.left_out) {
      for (std::int32_t& i : facet)
        if (i >= 0) i = new_number[i];
      std::sort(facet.begin(), facet.end());
    }
    std::sort(set.left_out.begin(), set.left_out.end());
  }
  return result;
}

Mesh interleaved(const Mesh& mesh) {
  constexpr std::size_t window = 192, n_apart = 16;
  std::vector<std::int32_t> nodes(mesh.X.size()), order(mesh.element_type.size()), tetrahedra;
  std::iota(nodes.begin(), nodes.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  std::copy_if(order.begin(), order.end(), std::back_inserter(tetrahedra),
               [&](std::int32_t e) { return mesh.element_type[e] == ElementType::tet4; });
  for (std::size_t first = 0; first < tetrahedra.size(); first += window) {
    const std::size_t apart = std::min(window, tetrahedra.size() - first) / n_apart;
    for (std::size_t k = 0; k < apart * n_apart; ++k)
      order[tetrahedra[first + k]] = tetrahedra[first + k % n_apart * apart + k / n_apart];
  }
  Mesh result = mesh;
  take_elements(mesh, order, nodes, result);
  return result;
}

Mesh in_near_order(const Mesh& mesh) {
  constexpr double worth = 0.75;
  const Mesh near = renumbered(mesh);
  return interleaved(mean_node_span(near) < worth * mean_node_span(mesh) ? near : mesh);
}

}  // namespace trocar
