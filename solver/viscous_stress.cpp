#include "solver/viscous_stress.h"

#include "solver/history.h"
#include "solver/hourglass_history.h"
#include "solver/simd.h"

namespace trocar {

static std::byte* beyond_blocks(const void* at, std::int64_t n, std::int64_t n_values) {
  constexpr std::int64_t line = 64;  // bytes of one value of a block, of any precision
  return const_cast<std::byte*>(static_cast<const std::byte*>(at)) + n * n_values * line;
}

// What laws and hourglass kernels ask of it.
static BlockTask one_block(const BlockTask& task, std::int64_t block) {
  BlockTask one = task;
  one.n_blocks = 1;
  one.data = beyond_blocks(task.data, block, task.n_values);
  one.stash = beyond_blocks(task.stash, block, task.n_stash);
  return one;
}

void put_viscous_stress(const ElementBlocks& blocks, const BlockKernels& kernels,
                        const BlockTask& task, const ViscousStep& step, double* history) {
  if (!has_hourglass_forces(blocks.formulation))
    return kernels.law.viscous_stress(task, step, history);
  const HourglassKernels& hourglass =
      active_kernels().of[static_cast<int>(blocks.precision)].hourglass;
  const bool is_small_strain = blocks.material == MaterialModel::linear;
  const auto relax = hourglass.relax[is_small_strain][static_cast<int>(blocks.formulation)];
  const std::int64_t of_points = task.n_points * history_of_point(step.n_branches) * blocks.lanes;
  for (std::int64_t block = 0; block < task.n_blocks; ++block) {
    alignas(64) std::byte balance[64 * tensor_values];
    const BlockTask one = one_block(task, block);
    relax(one, step, history + of_points, balance);
    kernels.law.viscous_stress(one, step, history);
    hourglass.balance(one, balance);
    history += history_width(blocks) * blocks.lanes;
  }
}

}  // namespace trocar
