// A box that is opened along the plane z = 1/2 in its x > 1/2 half.
#pragma once

#include "mesh/edit.h"
#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {

struct OpenedBox {
  Mesh mesh;  // before
  MeshEdit edit;

  explicit OpenedBox(BoxElements elements = BoxElements::tet4_kuhn)
      : mesh(make_box(Vec3::Zero(), Vec3::Ones(), {4, 4, 4}, elements)) {
    std::vector<std::int32_t> copy(mesh.X.size(), -1);
    for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.X[i].z() == 0.5 && mesh.X[i].x() > 0.5) {
        copy[i] = mesh.n_nodes() + static_cast<std::int32_t>(edit.duplicate_parent.size());
        edit.duplicate_parent.push_back(i);
      }
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) open_element(e, copy);
  }
  void open_element(std::int32_t e, const std::vector<std::int32_t>& copy) {
    const std::span<const std::int32_t> node = mesh.corners(e);
    double z = 0;
    for (const std::int32_t i : node) z += mesh.X[i].z() / static_cast<double>(node.size());
    for (std::size_t a = 0; a < node.size() && z > 0.5; ++a)
      if (copy[node[a]] >= 0)
        edit.corners.push_back({e, static_cast<std::int32_t>(a), copy[node[a]]});
  }
};

}  // namespace trocar
