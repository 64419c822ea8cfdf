// Hexahedra to split into tetrahedra, and what becomes of them.
#pragma once

#include <numeric>

#include "mesh/edit.h"
#include "mesh/hex_split.h"

namespace trocar {

inline ElementSplit split_of(const Mesh& mesh, std::int32_t e) {
  return {.element = e, .corner = hex_tet_nodes(mesh, e)};
}

inline std::vector<ElementSplit> splits_of(const Mesh& mesh,
                                           std::span<const std::int32_t> elements) {
  std::vector<ElementSplit> splits;
  for (const std::int32_t e : elements) splits.push_back(split_of(mesh, e));
  return splits;
}

// (n_elements after the edit) The element that each is, or is a part of.
inline std::vector<std::int32_t> wholes_of(const Mesh& before, const MeshEdit& edit) {
  std::vector<std::int32_t> whole(before.element_type.size());
  std::iota(whole.begin(), whole.end(), 0);
  for (const ElementSplit& split : edit.splits)
    for (std::int32_t k = 1; k < split.n_tets; ++k) whole.push_back(split.element);
  return whole;
}

}  // namespace trocar
