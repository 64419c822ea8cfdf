// The bodies of the benches of a step.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver_body.h"

namespace trocar {

// A cube whose nodes are moved by up to a tenth of a cell, so that no element is a parallelepiped.
inline Mesh jittered_body(Formulation formulation, int n_elements) {
  const ElementType shape = shape_of(formulation);
  const int per_cell = shape == ElementType::tet4 ? 6 : (shape == ElementType::tri3 ? 2 : 1);
  const bool is_plane = shape == ElementType::tri3;
  const int n = std::max(
      1,
      static_cast<int>(std::lround(std::pow(n_elements / per_cell, is_plane ? 1. / 2 : 1. / 3))));
  Mesh mesh =
      is_plane ? make_rectangle(.1, .1, n, n)
               : make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {n, n, n},
                          shape == ElementType::hex8 ? BoxElements::hex8 : BoxElements::tet4_kuhn);
  std::uint64_t seed = 1;
  for (Vec3& X : mesh.X)
    for (int j = 0; j < (is_plane ? 2 : 3); ++j) {
      seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
      X[j] += .1 / n * (static_cast<double>(seed >> 11) * 0x1p-53 - .5) * .2;
    }
  return mesh;
}

// Its elements in another order, each some ten places from where it was, so that none stand in rows
// (solver/row_order.h), as in a mesh that is no box.
inline void disorder_elements(Mesh& mesh) {
  const auto n = static_cast<std::size_t>(n_corners(mesh.element_type.front()));
  std::uint64_t seed = 1;
  for (std::size_t e = 0; e + 1 < mesh.element_type.size(); ++e) {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    const std::size_t other = std::min(e + (seed >> 60), mesh.element_type.size() - 1);
    std::swap_ranges(&mesh.corner_node[n * e], &mesh.corner_node[n * e] + n,
                     &mesh.corner_node[n * other]);
  }
}

}  // namespace trocar
