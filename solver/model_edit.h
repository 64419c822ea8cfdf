// A model after an edit that left every element its place in the lists: the numbers of edited
// elements and nodes are made anew, the others stay. What is left in proportion to the model is the
// order of sums, whole numbers only, and positions in single precision.
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
// The part has the elements that it had, in lists that read halo nodes or don't as before.
// elements: global numbers of those with other corners, positions or densities; nodes: all corners
// of these, before and after. Without mass scaling. The result is build_model's.
void edit_model(const ModelSource& source, std::span<const std::int32_t> elements,
                std::span<const std::int32_t> nodes, Model& model);

}  // namespace trocar
