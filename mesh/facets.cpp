// Who is next to whom: across facets, around nodes, along edges, and on the boundary.
#include "mesh/facets.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/sort_unique.h"
#include "mesh/facet_sort.h"
#include "mesh/hex_split.h"

namespace trocar {

FacetNeighbours facet_neighbours(const Mesh& mesh) {
  FacetNeighbours result;
  result.offset.assign(1, 0);
  for (const ElementType type : mesh.element_type)
    result.offset.push_back(result.offset.back() + n_facets(type));
  result.neighbour.assign(static_cast<std::size_t>(result.offset.back()), -1);

  for_each_facet(mesh, [&](std::span<const FacetSide> side) {
    if (side.size() > 2)
      throw InputError("the facet of nodes" + nodes_text(side[0].node) +
                       " is shared by more than two elements: " + std::to_string(side[0].element) +
                       ", " + std::to_string(side[1].element) + ", " +
                       std::to_string(side[2].element));
    if (side.size() == 1) return;
    const FacetSide &a = side[0], &b = side[1];
    result.neighbour[result.offset[a.element] + a.facet] = b.element;
    result.neighbour[result.offset[b.element] + b.facet] = a.element;
  });
  return result;
}

NodeElements node_elements(const Mesh& mesh) {
  return group_items(mesh.X.size(), [&](const auto& put) {
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      for (const std::int32_t i : mesh.corners(e)) put(i, e);
  });
}

std::vector<std::array<std::int32_t, 2>> mesh_edges(const Mesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> edge;
  const NodeElements around = node_elements(mesh);
  std::vector<std::int32_t> above;  // neighbours of node i with a higher number
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    above.clear();
    for (const std::int32_t e : around.of(i))
      for (const auto& [a, b] : edge_corners(mesh.element_type[e])) {
        const std::int32_t from = mesh.corners(e)[a], to = mesh.corners(e)[b];
        if (std::min(from, to) == i) above.push_back(std::max(from, to));
      }
    sort_unique(above);
    for (const std::int32_t j : above) edge.push_back({i, j});
  }
  return edge;
}

static void add_triangle(Surface& surface, const std::array<std::int32_t, 3>& triangle,
                         std::int32_t e, bool is_cut, bool is_quad_half = false) {
  surface.triangle.push_back(triangle);
  surface.element.push_back(e);
  surface.is_cut.push_back(is_cut ? 1 : 0);
  surface.is_quad_half.push_back(is_quad_half ? 1 : 0);
}

void add_facet(Surface& surface, const Mesh& mesh, std::int32_t e, int f) {
  const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
  if (corner[2] < 0) return;  // the edge of a triangle has no area
  std::array<std::int32_t, 4> node{};
  const std::size_t n = corner[3] < 0 ? 3 : 4;
  for (std::size_t a = 0; a < n; ++a) node[a] = mesh.corners(e)[corner[a]];
  const bool is_cut = (mesh.cut_facets[e] >> f & 1) != 0;
  // As hex_tets splits it: the surface depends neither on the side nor on what a cut makes of the
  // hexahedron.
  if (n == 4)
    std::rotate(node.begin(),
                std::min_element(
                    node.begin(), node.end(),
                    [&](std::int32_t i, std::int32_t j) { return is_diagonal_at(mesh, i, j); }),
                node.end());
  add_triangle(surface, {node[0], node[1], node[2]}, e, is_cut, n == 4);
  if (n == 4) add_triangle(surface, {node[0], node[2], node[3]}, e, is_cut, true);
}

std::vector<std::uint8_t> boundary_facets(const Mesh& mesh) {
  std::vector<std::uint8_t> is_boundary(mesh.element_type.size(), 0);
  const std::vector<FacetSide> single = single_sides(mesh);
  for (const FacetSide& side : single) {
    std::uint8_t& bits = is_boundary[side.element];
    bits = static_cast<std::uint8_t>(bits | 1U << side.facet);
  }
  const auto clear = [&](std::int32_t e, std::int32_t f) {
    is_boundary[e] = static_cast<std::uint8_t>(is_boundary[e] & ~(1U << f));
  };
  for (const SplitQuad& quad : split_quads(mesh, single)) {
    clear(quad.hex, quad.facet);
    for (const FacetSide& triangle : quad.triangle) clear(triangle.element, triangle.facet);
  }
  return is_boundary;
}

static std::vector<std::int32_t> used_nodes(const Surface& surface, std::size_t n_nodes) {
  std::vector<std::uint8_t> is_used(n_nodes, 0);
  for (const std::array<std::int32_t, 3>& triangle : surface.triangle)
    for (const std::int32_t i : triangle) is_used[i] = 1;
  std::vector<std::int32_t> node;
  for (std::size_t i = 0; i < n_nodes; ++i)
    if (is_used[i] != 0) node.push_back(static_cast<std::int32_t>(i));
  return node;
}

Surface boundary_surface(const Mesh& mesh) {
  Surface surface;
  if (mesh.dimension() == 2) {
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      const std::span<const std::int32_t> node = mesh.corners(e);
      add_triangle(surface, {node[0], node[1], node[2]}, e, false);
    }
  } else {
    const std::vector<std::uint8_t> is_boundary = boundary_facets(mesh);
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
        if ((is_boundary[e] >> f & 1) != 0) add_facet(surface, mesh, e, f);
  }
  surface.node = used_nodes(surface, mesh.X.size());
  return surface;
}

}  // namespace trocar
