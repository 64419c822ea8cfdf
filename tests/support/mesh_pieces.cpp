#include "mesh_pieces.h"

#include <algorithm>
#include <array>

#include "mesh/facets.h"
#include "mesh/hex_split.h"

namespace trocar {

// Hexahedra and tetrahedra that share a quad: (element, the other one), both ways, ascending.
static std::vector<std::array<std::int32_t, 2>> neighbours_at_quads(const Mesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (const SplitQuad& quad : split_quads(mesh, single_sides(mesh)))
    for (const FacetSide& triangle : quad.triangle) {
      pairs.push_back({quad.hex, triangle.element});
      pairs.push_back({triangle.element, quad.hex});
    }
  std::ranges::sort(pairs);
  return pairs;
}

std::vector<std::int32_t> element_pieces(const Mesh& mesh) {
  const FacetNeighbours across = facet_neighbours(mesh);
  const std::vector<std::array<std::int32_t, 2>> at_quads = neighbours_at_quads(mesh);
  std::vector<std::int32_t> piece(mesh.element_type.size(), -1), open;
  std::int32_t n = 0;
  for (std::int32_t first = 0; first < mesh.n_elements(); ++first) {
    if (piece[first] >= 0) continue;
    const auto reach = [&](std::int32_t e) {
      if (e < 0 || piece[e] >= 0) return;
      piece[e] = n;
      open.push_back(e);
    };
    reach(first);
    while (!open.empty()) {
      const std::int32_t e = open.back();
      open.pop_back();
      for (int f = 0; f < n_facets(mesh.element_type[e]); ++f) reach(across.of(e, f));
      for (auto at = std::ranges::lower_bound(at_quads, std::array{e, -1});
           at != at_quads.end() && (*at)[0] == e; ++at)
        reach((*at)[1]);
    }
    ++n;
  }
  return piece;
}

std::int32_t n_pieces(const Mesh& mesh) {
  return mesh.n_elements() == 0 ? 0 : 1 + std::ranges::max(element_pieces(mesh));
}

}  // namespace trocar
