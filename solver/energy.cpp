// Strain energies of nodes and elements, one by one.
#include <algorithm>

#include "solver/block_ranges.h"
#include "solver/simd.h"
#include "solver/watch.h"

namespace trocar {

namespace {

// Of the ranks that compute an element, one counts it: the owner of its lowest global node.
bool is_counted_here(const Model& model, const Part& part, const ElementBlocks& blocks,
                     std::int64_t lane) {
  const std::int64_t n = std::ssize(blocks.corner) / (std::int64_t{blocks.n_blocks} * blocks.lanes);
  const std::int64_t first = first_of_lane(lane, blocks.lanes, n);
  std::int32_t lowest = blocks.corner[first];
  for (std::int64_t a = 1; a < n; ++a) {
    const std::int32_t node = blocks.corner[first + a * blocks.lanes];
    if (part.node_global[node] < part.node_global[lowest]) lowest = node;
  }
  return lowest < model.n_owned;
}

void take_list(const Model& model, const Part& part, const State& state,
               const ElementBlocks& blocks, EnergyTerms& terms) {
  std::vector<double> strain(blocks.element_local.size()), hourglass(strain.size());
  parallel_for(std::int64_t{blocks.n_blocks}, [&](std::int64_t begin, std::int64_t end) {
    for_strained_blocks(
        model, blocks, state, begin, end - begin,
        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
          kernels.law.energy(task, strain.data() + block * blocks.lanes);
          kernels.element.hourglass(task, hourglass.data() + block * blocks.lanes);
        });
  });
  for (std::int64_t lane = 0; lane < blocks.n_elements; ++lane) {
    if (!is_counted_here(model, part, blocks, lane)) continue;
    terms.strain.push_back(strain[lane]);
    terms.hourglass.push_back(hourglass[lane]);
  }
}

// sum_a (V_a/4) K/2 theta_a^2 less the elements' share, of owned nodes.
void take_volumetric(const Model& model, const State& state, std::vector<double>& volumetric) {
  const std::vector<double>& stiffness = model.averages.stiffness;
  volumetric.clear();
  const auto n_fields = static_cast<std::size_t>(model.averages.n_fields);
  for (std::size_t item = 0; item < stiffness.size(); ++item) {
    const double theta = state.theta[item];
    if (stiffness[item] > 0)
      volumetric.push_back((1 - model.averages.share[item % n_fields]) * stiffness[item] / 8 *
                           theta * theta);
  }
}

}  // namespace

void energy_terms(const Model& model, const Part& part, const State& state, EnergyTerms& terms) {
  take_volumetric(model, state, terms.volumetric);
  terms.strain.clear();
  terms.hourglass.clear();
  for (const ElementBlocks& blocks : model.blocks) take_list(model, part, state, blocks, terms);
}

}  // namespace trocar
