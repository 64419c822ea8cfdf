// A model after an edit: the numbers of edited elements and nodes are made anew, the others stay or
// go with their elements. What is left in proportion to the model is the order of sums, whole
// numbers only (nodes are copied and rows searched on one thread of one rank, elements passed
// else), positions in single precision, which blocks lie along the axes, the lanes that averaged
// volume changes link, and copies of the lists from which hexahedra were split.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/model.h"

namespace trocar {

// As for build_model.
struct ModelSource {
  const Mesh& mesh;
  const Part& part;
  std::span<const Material> materials;
  const SolverOptions& options;
  std::span<const FixedMask> fixed = {};  // only where nodes are taken
  std::span<const double> mass = {};      // the same

  std::int32_t n_elements() const { return static_cast<std::int32_t>(part.element_global.size()); }
  const Material& material(std::int32_t e) const { return materials[mesh.element_region[e]]; }
};
// Global numbers, ascending.
struct ModelEdit {
  std::span<const std::int32_t> elements;  // those with other corners, positions or densities
  std::span<const std::int32_t> nodes;     // all corners of these, before and after
  std::span<const std::int32_t> touching;  // all elements that touch the nodes now
  // (elements of the part) Where in the part each was before, -1: new; empty: all where they are.
  std::span<const std::int32_t> place_before;
};
// Elements that are not new read halo nodes or don't, as before. Without mass scaling. The result
// is build_model's. History (State::history) stays with its elements; that of new ones is zero.
void edit_model(const ModelSource& source, const ModelEdit& edit, Model& model,
                std::vector<double>& history);

// values (elements of the part): from before the edit to after it, zero for new elements.
template <class T>
void move_to_places(std::span<const std::int32_t> place_before, std::vector<T>& values) {
  if (place_before.empty()) return;
  std::vector<T> moved;
  moved.reserve(place_before.size());
  for (const std::int32_t k : place_before) moved.push_back(k >= 0 ? values[k] : T{});
  values = std::move(moved);
}

}  // namespace trocar
