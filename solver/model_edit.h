// A model after an edit that left every element its place in the lists: the numbers of edited
// elements and nodes are made anew, the others stay. What is left in proportion to the model is the
// order of sums, whole numbers only (nodes are copied and rows searched on one thread of one rank,
// elements passed else), and positions in single precision.
#pragma once

#include <cstdint>
#include <span>

#include "solver/model.h"

namespace trocar {

// As for build_model.
struct ModelSource {
  const Mesh& mesh;
  const Part& part;
  std::span<const Material> materials;
  std::span<const FixedMask> fixed;
  std::span<const double> mass;
};
// Global numbers, ascending.
struct ModelEdit {
  std::span<const std::int32_t> elements;  // those with other corners, positions or densities
  std::span<const std::int32_t> nodes;     // all corners of these, before and after
  std::span<const std::int32_t> touching;  // all elements that touch the nodes now
};
// The part has the elements that it had, in lists that read halo nodes or don't as before. Without
// mass scaling. The result is build_model's.
void edit_model(const ModelSource& source, const ModelEdit& edit, Model& model);

}  // namespace trocar
