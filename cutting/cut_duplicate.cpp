// Components of stars by breadth-first search over facets that contain the node.
#include "cutting/cut_duplicate.h"

#include <algorithm>

#include "base/sort_unique.h"

namespace trocar {

namespace {

using ElementFacet = std::array<std::int32_t, 2>;

struct Separation {
  const Mesh& mesh;
  const FacetNeighbours& across;
  std::vector<ElementFacet> opened;  // ascending

  // Bit f: facet f of element e is open.
  unsigned open_facets(std::int32_t e) const {
    unsigned mask = mesh.cut_facets[e];
    for (auto at = std::lower_bound(opened.begin(), opened.end(), ElementFacet{e, 0});
         at != opened.end() && (*at)[0] == e; ++at)
      mask |= 1U << (*at)[1];
    return mask;
  }
};

int corner_of(const Mesh& mesh, std::int32_t e, std::int32_t node) {
  const std::span<const std::int32_t> corner = mesh.corners(e);
  return static_cast<int>(std::find(corner.begin(), corner.end(), node) - corner.begin());
}

bool contains_corner(ElementType type, int f, int corner) {
  if (type != ElementType::hex8) return f != corner;
  const std::array<int, 4> corners = facet_corners(type, f);
  return std::find(corners.begin(), corners.end(), corner) != corners.end();
}

// Adds the elements of the star that hang together with `star[first]` to its component.
void flood(const Separation& separation, std::int32_t node, std::span<const std::int32_t> star,
           std::size_t first, std::vector<int>& component) {
  const Mesh& mesh = separation.mesh;
  std::vector<std::size_t> open{first};
  while (!open.empty()) {
    const std::size_t k = open.back();
    open.pop_back();
    const std::int32_t e = star[k];
    const ElementType type = mesh.element_type[e];
    const int corner = corner_of(mesh, e, node), n = n_facets(type);
    const unsigned is_open = separation.open_facets(e);
    for (int f = 0; f < n; ++f) {
      if (!contains_corner(type, f, corner) || (is_open >> f & 1) != 0) continue;
      const std::int32_t u = separation.across.of(e, f);
      const auto next = std::lower_bound(star.begin(), star.end(), u);
      if (next == star.end() || *next != u) continue;
      const auto at = static_cast<std::size_t>(next - star.begin());
      if (component[at] >= 0) continue;
      component[at] = component[first];
      open.push_back(at);
    }
  }
}

int star_components(const Separation& separation, std::int32_t node,
                    std::span<const std::int32_t> star, std::vector<int>& component) {
  component.assign(star.size(), -1);
  int n_components = 0;
  for (std::size_t first = 0; first < star.size(); ++first) {
    if (component[first] >= 0) continue;
    component[first] = n_components++;
    flood(separation, node, star, first, component);
  }
  return n_components;
}

}  // namespace

Duplication duplicate_nodes(const Mesh& mesh, std::span<const ElementFacet> opened,
                            std::span<const std::int32_t> nodes, const NodeElements& around,
                            const FacetNeighbours& across) {
  Separation separation{mesh, across, {opened.begin(), opened.end()}};
  std::sort(separation.opened.begin(), separation.opened.end());
  std::vector<std::int32_t> ascending(nodes.begin(), nodes.end());
  sort_unique(ascending);

  Duplication result;
  std::vector<int> component;
  for (const std::int32_t node : ascending) {
    const std::span<const std::int32_t> star = around.of(node);
    const int n_components = star_components(separation, node, star, component);
    const std::int32_t first_duplicate =
        mesh.n_nodes() + static_cast<std::int32_t>(result.duplicate_parent.size());
    for (std::size_t k = 0; k < star.size(); ++k)
      if (component[k] > 0)
        result.corners.push_back(
            {star[k], corner_of(mesh, star[k], node), first_duplicate + component[k] - 1});
    for (int k = 1; k < n_components; ++k) result.duplicate_parent.push_back(node);
  }
  std::sort(result.corners.begin(), result.corners.end(), [](const auto& a, const auto& b) {
    return a.element != b.element ? a.element < b.element : a.corner < b.corner;
  });
  return result;
}

}  // namespace trocar
