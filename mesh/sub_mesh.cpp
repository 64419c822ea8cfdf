#include "mesh/sub_mesh.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "mesh/node_corners.h"

namespace trocar {

SubMesh make_sub_mesh(const Mesh& mesh, std::span<const std::int32_t> elements) {
  SubMesh sub{.mesh = {.region_name = mesh.region_name},
              .node = nodes_of(mesh, elements),
              .element = {elements.begin(), elements.end()}};
  for (const std::int32_t i : sub.node) sub.mesh.X.push_back(mesh.X[i]);
  const auto number = [&](std::int32_t i) { return place_in(sub.node, i); };
  for (const std::int32_t e : elements) {
    std::array<std::int32_t, max_corners> corner{};
    const std::span<const std::int32_t> node = mesh.corners(e);
    std::transform(node.begin(), node.end(), corner.begin(), number);
    add_element(sub.mesh, mesh.element_type[e], std::span(corner).first(node.size()),
                mesh.element_region[e]);
    sub.mesh.density_factor.back() = mesh.density_factor[e];
    if (!mesh.fibre.empty()) sub.mesh.fibre.push_back(mesh.fibre[e]);
  }
  return sub;
}

}  // namespace trocar
