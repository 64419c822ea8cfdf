#include "solver/thickness.h"

#include <array>

#include "solver/block_ranges.h"

namespace trocar {

namespace {

// det of the in-plane F of a lane of the first block in the stash.
template <class Real>
double area_stretch(const BlockTask& task, const ElementBlocks& blocks, std::int64_t lane) {
  const Real* const stash = static_cast<const Real*>(task.stash) + lane;
  const auto H = [&](int i, int j) { return double{stash[(3 * i + j) * blocks.lanes]}; };
  return 1 + (H(0, 0) + H(1, 1) + (H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0)));
}

}  // namespace

double thickness_stretch(const Model& model, const State& state, std::int32_t element) {
  double stretch = 1;
  for (const ElementBlocks& blocks : model.blocks) {
    if (blocks.formulation != Formulation::tri3_plane_stress) continue;
    const std::int64_t place = lane_of(blocks, element), lane = place % blocks.lanes;
    if (place < 0) continue;
    for_strained_blocks(model, blocks, state, place / blocks.lanes, 1,
                        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t) {
                          const double area = blocks.precision == Precision::in_single
                                                  ? area_stretch<float>(task, blocks, lane)
                                                  : area_stretch<double>(task, blocks, lane);
                          std::array<double, lanes_of_block<float>> enough, J, stiffening;
                          enough.fill(1e30);  // nobody asks for the growth
                          kernels.law.watch(task, {enough.data()}, J.data(), stiffening.data());
                          stretch = J[lane] / area;
                        });
  }
  return stretch;
}

}  // namespace trocar
