#include "solver/history.h"

#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/elementary.h"
#include "solver/simd.h"

namespace trocar {

ViscousStep viscous_step(const std::vector<PronyBranch>& prony, double dt) {
  ViscousStep step{.n_branches = static_cast<int>(prony.size())};
  CHECK_OP(step.n_branches, <=, max_prony_branches);
  for (std::size_t b = 0; b < prony.size(); ++b) {
    const double x = dt / prony[b].time, fall = -expm1_of(-x);  // 1 - exp(-x)
    step.share_sum += prony[b].share;
    step.decay[b] = 1 - fall;
    step.gain[b] = prony[b].share * (x > 0 ? fall / x : 1);
  }
  return step;
}

int history_width(const ElementBlocks& blocks) {
  if (blocks.prony.empty()) return 0;
  return kernels_for(kernels_of(Simd::scalar), blocks).element.n_points *
         history_of_point(static_cast<int>(blocks.prony.size()));
}

std::int64_t place_history(std::vector<ElementBlocks>& lists) {
  std::int64_t next = 0;
  for (ElementBlocks& blocks : lists) {
    blocks.first_history = next;
    next += std::int64_t{blocks.n_blocks} * blocks.lanes * history_width(blocks);
  }
  return next;
}

// Calls body(element, first number, width, lanes between numbers) for all elements with history.
template <class Body>
static void for_histories(const Model& model, const Part& part, const Body& body) {
  for (const ElementBlocks& blocks : model.blocks) {
    const int width = history_width(blocks);
    for (std::int64_t lane = 0; lane < blocks.n_elements && width > 0; ++lane) {
      const std::int64_t block = lane / blocks.lanes;
      body(part.element_global[blocks.element_local[lane]],
           blocks.first_history + block * width * blocks.lanes + lane % blocks.lanes, width,
           blocks.lanes);
    }
  }
}

std::vector<double> copy_history(const Model& model, const Part& part, const State& state) {
  std::vector<double> copy;
  for_histories(model, part, [&](std::int32_t e, std::int64_t first, int width, int lanes) {
    copy.push_back(e);
    copy.push_back(width);
    for (int k = 0; k < width; ++k) copy.push_back(state.history[first + k * lanes]);
  });
  return copy;
}

void restore_history(const Model& model, const Part& part, std::span<const double> copies,
                     std::span<const std::int32_t> parent, std::span<const double> scale,
                     State& state) {
  CHECK_OP(parent.size(), ==, scale.size());
  const std::int32_t last = parent.empty() ? -1 : parent.back();  // parents ascend
  std::vector<std::size_t> place(static_cast<std::size_t>(last) + 1, copies.size());
  for (std::size_t at = 0; at < copies.size(); at += 2 + static_cast<std::size_t>(copies[at + 1]))
    if (copies[at] <= last) place[static_cast<std::size_t>(copies[at])] = at;
  for_histories(model, part, [&](std::int32_t e, std::int64_t first, int width, int lanes) {
    const auto element = static_cast<std::size_t>(e);
    const std::size_t at = place[static_cast<std::size_t>(parent[element])];
    if (at == copies.size()) return;
    const int n = static_cast<int>(copies[at + 1]);
    CHECK_OP(n % width, ==, 0);
    const double n_parent_points = n / width;  // for each point of this element
    for (int k = 0; k < n; ++k) {
      const double value =
          scale[element] * copies[at + 2 + static_cast<std::size_t>(k)] / n_parent_points;
      double& number = state.history[first + k % width * lanes];
      number = k < width ? value : number + value;
    }
  });
}

}  // namespace trocar
