// Around one node after the other, so that a million hexahedra take 28 MB: all sides at once 340.
#include "mesh/facet_sort.h"

#include <algorithm>
#include <limits>

#include "base/grouped.h"
#include "mesh/element_shape.h"

namespace trocar {

static void put_in_order(std::int32_t& a, std::int32_t& b) {
  const std::int32_t least = std::min(a, b);
  b = std::max(a, b);
  a = least;
}

static FacetSide facet_side(const Mesh& mesh, std::int32_t e, int f) {
  const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
  const std::span<const std::int32_t> node = mesh.corners(e);
  FacetSide side{{-1, -1, -1, -1}, e, f};
  for (std::size_t a = 0; a < 4 && corner[a] >= 0; ++a) side.node[a] = node[corner[a]];
  auto& [a, b, c, d] = side.node;
  put_in_order(a, b);
  put_in_order(c, d);
  put_in_order(a, c);
  put_in_order(b, d);
  put_in_order(b, c);
  return side;
}

static std::int32_t lowest_node(const Mesh& mesh, std::int32_t e, int f) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
  for (const int corner : facet_corners(mesh.element_type[e], f))
    if (corner >= 0) lowest = std::min(lowest, node[corner]);
  return lowest;
}

// Facets of all elements by their lowest node, as 8 element + facet.
static Grouped<std::uint32_t, std::uint32_t> facets_of_nodes(const Mesh& mesh) {
  return group_items<std::uint32_t, std::uint32_t>(mesh.X.size(), [&](const auto& put) {
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
        put(lowest_node(mesh, e, f),
            8 * static_cast<std::uint32_t>(e) + static_cast<std::uint32_t>(f));
  });
}

void for_each_facet(const Mesh& mesh,
                    const std::function<void(std::span<const FacetSide>)>& visit) {
  const Grouped<std::uint32_t, std::uint32_t> facets = facets_of_nodes(mesh);
  std::vector<FacetSide> side;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    side.clear();
    for (const std::uint32_t k : facets.of(i))
      side.push_back(facet_side(mesh, static_cast<std::int32_t>(k / 8), static_cast<int>(k % 8)));
    std::sort(side.begin(), side.end());
    for (auto begin = side.begin(), end = begin; begin != side.end(); begin = end) {
      end = std::find_if(begin, side.end(),
                         [&](const FacetSide& s) { return s.node != begin->node; });
      visit({begin, end});
    }
  }
}

std::string nodes_text(std::span<const std::int32_t> node) {
  std::string text;
  for (const std::int32_t i : node)
    if (i >= 0) text.append(" ").append(std::to_string(i));
  return text;
}

std::vector<FacetSide> single_sides(const Mesh& mesh) {
  std::vector<FacetSide> single;
  for_each_facet(mesh, [&](std::span<const FacetSide> side) {
    if (side.size() == 1) single.push_back(side[0]);
  });
  return single;
}

}  // namespace trocar
