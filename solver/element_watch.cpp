#include "solver/element_watch.h"

#include <algorithm>
#include <array>
#include <atomic>
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
using Room = std::array<double, stash_blocks * lanes_of_block<float>>;

// Values of elements, whose numbers rise: where they lie, if side by side, or in `room`.
const double* values_of(std::span<const double> of_all, std::span<const std::int32_t> element,
                        Room& room) {
  if (of_all.empty()) return nullptr;
  const std::size_t n = element.size();
  if (static_cast<std::size_t>(element[n - 1] - element[0]) == n - 1) return &of_all[element[0]];
  for (std::size_t lane = 0; lane < n; ++lane) room[lane] = of_all[element[lane]];
  return room.data();
}

// Of the task, from block `first` of the list on, without padding.
std::span<const std::int32_t> elements_of(const ElementBlocks& blocks, const BlockTask& task,
                                          std::int64_t first) {
  const std::int64_t begin = first * blocks.lanes;
  const std::int64_t n = std::min(task.n_blocks * blocks.lanes, blocks.n_elements - begin);
  return {blocks.element_local.data() + begin, static_cast<std::size_t>(n)};
}

}  // namespace

// What is known of a task's elements, lane by lane.
struct ElementWatch::Lanes {
  double at_rest;         // `growth` of the kernels in the undeformed element
  const double* step;     // there
  const double* earlier;  // as in WatchWishes; null where it is empty
};

void ElementWatch::begin_with(const Model& model, const State& state, std::int32_t element) {
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int32_t lane = lane_of(blocks, part_.place_of(element));
    if (lane < 0) continue;
    for_strained_blocks(
        model, blocks, state, lane / blocks.lanes, 1,
        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
          look(model, blocks, kernels, task, block, first_);
        });
  }
  found_ = first_;
}

// Growth that sets neither the least step nor the largest growth.
void ElementWatch::find_enough(const Lanes& lanes, const LeastOfElements& least,
                               std::span<double> enough) const {
  const double by_step =
      wishes_.stiffening.empty() ? lanes.at_rest / (least.step.value * least.step.value) : 0;
  for (std::size_t lane = 0; lane < enough.size(); ++lane)
    enough[lane] = lanes.step[lane] * lanes.step[lane] * by_step;
  if (wishes_.earlier.empty()) return;
  const double by_growth = lanes.at_rest * least.growth;
  for (std::size_t lane = 0; lane < enough.size(); ++lane)
    enough[lane] = std::min(enough[lane], by_growth * lanes.earlier[lane]);
}

void ElementWatch::look(const Model& model, const ElementBlocks& blocks,
                        const BlockKernels& kernels, const BlockTask& task, std::int64_t first,
                        LeastOfElements& least) const {
  const std::span element = elements_of(blocks, task, first);
  const std::size_t n_lanes = element.size();
  Room step_room, earlier_room, J, growth, enough;
  const Lanes lanes{.at_rest = blocks.stiffening_at_rest,
                    .step = values_of(model.element_step, element, step_room),
                    .earlier = values_of(wishes_.earlier, element, earlier_room)};
  find_enough(lanes, least, std::span(enough).first(n_lanes));
  std::fill(enough.begin() + static_cast<std::ptrdiff_t>(n_lanes), enough.end(), most_padding);
  const bool is_asked = !wishes_.stiffening.empty();
  const WatchLimits limits{.enough = enough.data(), .J = least.J.value, .at_rest = lanes.at_rest};
  if (!kernels.law.watch(task, limits, J.data(), growth.data()) && !is_asked) return;
  for (std::size_t lane = 0; lane < n_lanes; ++lane) {
    const double step = lanes.step[lane];
    const std::int32_t global = part_.element_global[element[lane]];
    growth[lane] = std::max(growth[lane] / lanes.at_rest, 1.0);  // this order keeps a NaN
    if (is_asked) wishes_.stiffening[element[lane]] = growth[lane];
    if (!is_out_of_question(step, J[lane], growth[lane], least))
      take_element(step, J[lane], growth[lane], global, least);
    if (!wishes_.earlier.empty() && growth[lane] > lanes.earlier[lane] * least.growth)
      take_growth(growth[lane] / lanes.earlier[lane], global, least);
  }
}

std::vector<GrownElement> find_grown(const Model& model, const Part& part, const State& state,
                                     std::span<const double> earlier, double growth,
                                     std::size_t most) {
  std::vector<GrownElement> grown;
  std::mutex mutex;
  std::atomic<bool> are_too_many = false;
  const auto look = [&](const ElementBlocks& blocks, const BlockKernels& kernels,
                        const BlockTask& task, std::int64_t first) {
    if (are_too_many) return;
    const std::span element = elements_of(blocks, task, first);
    Room room, enough, J, stiffening;
    const double* earlier_at = values_of(earlier, element, room);
    enough.fill(most_padding);
    for (std::size_t lane = 0; lane < element.size(); ++lane)
      enough[lane] = blocks.stiffening_at_rest * growth * earlier_at[lane];
    kernels.law.watch(task, {enough.data()}, J.data(), stiffening.data());
    for (std::size_t lane = 0; lane < element.size(); ++lane) {
      const double s = std::max(1.0, stiffening[lane] / blocks.stiffening_at_rest);
      if (!(s > growth * earlier_at[lane])) continue;
      const std::scoped_lock lock(mutex);
      grown.push_back({part.element_global[element[lane]], s});
      are_too_many = grown.size() > most;
    }
  };
  parallel_for(count_blocks(model), [&](std::int64_t begin, std::int64_t end) {
    for_strained_block_range(model, state, begin, end, look);
  });
  return grown;
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
