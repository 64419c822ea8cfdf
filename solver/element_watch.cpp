#include "solver/element_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// An element whose deformation is not a number has no stable step and counts as inverted.
void take_element(double undeformed_step, double J, double growth, std::int32_t global,
                  LeastOfElements& least) {
  const bool is_sound = std::isfinite(J) && growth < infinity;
  least.step.take(is_sound ? undeformed_step / std::sqrt(growth) : 0, global);
  least.J.take(is_sound ? J : -infinity, global);
}

// Most are not, so that most need no root. False for what is not finite.
bool is_out_of_question(double undeformed_step, double J, double growth,
                        const LeastOfElements& least) {
  constexpr double rounding = 1 + 1e-12;
  const double limit = least.step.value;
  return J > least.J.value && J < infinity &&
         undeformed_step * undeformed_step > limit * limit * growth * rounding;
}

}  // namespace

void ElementWatch::look(const Model& model, const ElementBlocks& blocks,
                        const BlockKernels& kernels, const BlockTask& task, std::int64_t first,
                        LeastOfElements& least) const {
  std::array<double, stash_blocks * lanes_of_block<float>> J, growth;
  kernels.law.watch(task, J.data(), growth.data());
  const std::int64_t begin = first * blocks.lanes;
  const auto n_lanes = static_cast<std::size_t>(
      std::min(task.n_blocks * blocks.lanes, blocks.n_elements - begin));  // the rest is padding
  const std::span element(blocks.element_local.data() + begin, n_lanes);
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    growth[lane] = std::max(1.0, growth[lane] / blocks.stiffening_at_rest);
  if (!stiffening_.empty())
    for (std::size_t lane = 0; lane < n_lanes; ++lane) stiffening_[element[lane]] = growth[lane];
  for (std::size_t lane = 0; lane < n_lanes; ++lane) {
    const double step = model.element_step[element[lane]];
    if (!is_out_of_question(step, J[lane], growth[lane], least))
      take_element(step, J[lane], growth[lane], part_.element_global[element[lane]], least);
  }
}

void ElementWatch::take(const LeastOfElements& least) {
  const std::scoped_lock lock(mutex_);
  least_.step.take(least.step.value, least.step.number);
  least_.J.take(least.J.value, least.J.number);
}

Watch ElementWatch::result() const {
  Watch w;
  w.stable_step = least_.step.value;
  w.stable_element = least_.step.number;
  w.least_J = least_.J.value;
  w.least_J_element = least_.J.number;
  return w;
}

}  // namespace trocar
