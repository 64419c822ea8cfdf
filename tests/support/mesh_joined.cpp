#include "mesh_joined.h"

#include <vector>

namespace trocar {

Mesh joined(Mesh mesh, const Mesh& other) {
  const std::int32_t n = mesh.n_nodes();
  mesh.X.insert(mesh.X.end(), other.X.begin(), other.X.end());
  for (std::int32_t e = 0; e < other.n_elements(); ++e) {
    std::vector<std::int32_t> corner;
    for (const std::int32_t i : other.corners(e)) corner.push_back(i + n);
    add_element(mesh, other.element_type[e], corner);
  }
  return mesh;
}

}  // namespace trocar
