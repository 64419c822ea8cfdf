// Some elements of a mesh as a mesh of their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

struct SubMesh {
  Mesh mesh;                          // no node sets, no copies
  std::vector<std::int32_t> node;     // (n_nodes) number in the whole mesh, ascending
  std::vector<std::int32_t> element;  // (n_elements) the same
};
// elements: ascending. In time of theirs, whatever the whole mesh.
SubMesh make_sub_mesh(const Mesh& mesh, std::span<const std::int32_t> elements);

// Of values of the whole mesh those of some nodes or elements, by number.
template <class T>
std::vector<T> values_of(std::span<const T> values, std::span<const std::int32_t> number) {
  std::vector<T> kept;
  kept.reserve(number.size());
  for (const std::int32_t i : number) kept.push_back(values[i]);
  return kept;
}

}  // namespace trocar
