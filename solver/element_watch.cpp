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

void take_growth(double growth, std::int32_t global, LeastOfElements& least) {
  if (growth <= least.growth) return;
  least.growth = growth;
  least.stiffest = global;
}

constexpr double most_padding = 1e30;
using Lanes = std::array<double, stash_blocks * lanes_of_block<float>>;

}  // namespace

void ElementWatch::begin_with(const Model& model, const State& state, std::int32_t element) {
  const auto begin = part_.element_global.begin();
  const auto at = std::lower_bound(begin, part_.element_global.end(), element);
  const auto local = static_cast<std::int32_t>(at - begin);
  for (const ElementBlocks& blocks : model.blocks) {
    const std::span list(blocks.element_local.data(), static_cast<std::size_t>(blocks.n_elements));
    const auto lane = std::lower_bound(list.begin(), list.end(), local);
    if (lane == list.end() || *lane != local) continue;
    for_strained_blocks(
        model, blocks, state, (lane - list.begin()) / blocks.lanes, 1,
        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
          look(model, blocks, kernels, task, block, first_);
        });
  }
  found_ = first_;
}

// Growth that sets neither the least step nor the largest growth.
void ElementWatch::find_enough(const Model& model, std::span<const std::int32_t> element,
                               double at_rest, const LeastOfElements& least,
                               std::span<double> enough) const {
  const double by_step =
      wishes_.stiffening.empty() ? at_rest / (least.step.value * least.step.value) : 0;
  for (std::size_t lane = 0; lane < element.size(); ++lane) {
    const double step = model.element_step[element[lane]];
    enough[lane] = step * step * by_step;
  }
  if (wishes_.earlier.empty()) return;
  const double by_growth = at_rest * least.growth;
  for (std::size_t lane = 0; lane < element.size(); ++lane)
    enough[lane] = std::min(enough[lane], by_growth * wishes_.earlier[element[lane]]);
}

void ElementWatch::look(const Model& model, const ElementBlocks& blocks,
                        const BlockKernels& kernels, const BlockTask& task, std::int64_t first,
                        LeastOfElements& least) const {
  const std::int64_t begin = first * blocks.lanes;
  const auto n_lanes =
      static_cast<std::size_t>(std::min(task.n_blocks * blocks.lanes, blocks.n_elements - begin));
  const std::span element(blocks.element_local.data() + begin, n_lanes);
  Lanes J, growth, enough;
  find_enough(model, element, blocks.stiffening_at_rest, least, enough);
  std::fill(enough.begin() + static_cast<std::ptrdiff_t>(n_lanes), enough.end(), most_padding);
  kernels.law.watch(task, enough.data(), J.data(), growth.data());
  for (std::size_t lane = 0; lane < n_lanes; ++lane) {
    const std::int32_t k = element[lane];
    const double step = model.element_step[k];
    growth[lane] = std::max(1.0, growth[lane] / blocks.stiffening_at_rest);
    if (!wishes_.stiffening.empty()) wishes_.stiffening[k] = growth[lane];
    if (!is_out_of_question(step, J[lane], growth[lane], least))
      take_element(step, J[lane], growth[lane], part_.element_global[k], least);
    if (!wishes_.earlier.empty() && growth[lane] > wishes_.earlier[k] * least.growth)
      take_growth(growth[lane] / wishes_.earlier[k], part_.element_global[k], least);
  }
}

void ElementWatch::take(const LeastOfElements& least) {
  const std::scoped_lock lock(mutex_);
  found_.step.take(least.step.value, least.step.number);
  found_.J.take(least.J.value, least.J.number);
  take_growth(least.growth, least.stiffest, found_);
}

Watch ElementWatch::result() const {
  Watch w;
  w.stable_step = found_.step.value;
  w.stable_element = found_.step.number;
  w.least_J = found_.J.value;
  w.least_J_element = found_.J.number;
  return w;
}

}  // namespace trocar
