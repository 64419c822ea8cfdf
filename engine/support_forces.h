// What the tissue does to the supports at rest. Moving ones are holds. Only for scenes with a
// metrics output.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/exact_sum.h"
#include "engine/scene.h"
#include "mesh/mesh.h"
#include "mesh/partition.h"

namespace trocar {

// A support's component of an owned node; of several that fix it, the first in the scene has it.
struct SupportedComponent {
  std::int32_t support = 0;    // number in the scene
  std::int64_t component = 0;  // 3 * local node + axis
};

struct SupportForces {
  std::vector<SupportedComponent> of_rank;
  std::vector<double> sum;  // (of_rank.size()) over the substeps of this frame [N]
};

// 0, 1, 2 for x, y, z in SceneSupport::fix, in its order.
std::vector<int> axes_of(const std::string& fix);
// Of each component of a node (n_nodes * 3) the first support at rest that fixes it, -1: none.
std::vector<std::int32_t> holders_at_rest(std::span<const SceneSupport> supports, const Mesh& mesh);
// After a change of part or topology.
void localise_supports(std::span<const SceneSupport> supports, const Mesh& mesh, const Part& part,
                       SupportForces& forces);
void forget_support_forces(SupportForces& forces);
// After integrate, whose force (n_owned * 3) at a supported component is what the support bears.
void add_support_forces(std::span<const double> force, SupportForces& forces);
// Mean force of the tissue on each support over n substeps; adds to force (n_supports), exact in
// any order.
void sum_support_forces(const SupportForces& forces, std::int64_t n_substeps,
                        std::span<ExactSum3> force);

// Of each support in metrics and summary: its region, with a number from the second of a region on
// that makes it no other's.
std::vector<std::string> support_names(std::span<const SceneSupport> supports);

}  // namespace trocar
