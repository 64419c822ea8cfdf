// Looks at all elements and owned nodes; the least values do not depend on the order in which
// threads find them.
#include "solver/watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/element_watch.h"

namespace trocar {

namespace {

// A body that has come so far [m] or so fast [m/s] has blown up; squares of it would overflow.
constexpr double limit = 1e9;

bool is_sane(double x) {
  return std::abs(x) < limit;  // false for NaN
}

// By the sum of squares, several at a time: none of them is near the limit where that is below its
// square. Else one by one.
bool are_sane(std::span<const double> x) {
  constexpr std::size_t width = 8;
  std::array<double, width> sum{};
  std::size_t k = 0;
  for (; k + width <= x.size(); k += width)
    for (std::size_t j = 0; j < width; ++j) sum[j] += x[k + j] * x[k + j];
  const double all = std::accumulate(sum.begin(), sum.end(), 0.0);
  const std::size_t first = all < limit * limit ? k : 0;
  return std::ranges::all_of(x.subspan(first), [](double value) { return is_sane(value); });
}

}  // namespace

void watch_elements(const Model& model, const State& state, ElementWatch& elements) {
  CHECK_OP(std::ssize(state.theta), ==, std::int64_t{model.n_local} * model.averages.n_fields);
  parallel_for(count_blocks(model), [&](std::int64_t begin, std::int64_t end) {
    LeastOfElements least = elements.first();
    for_strained_block_range(
        model, state, begin, end,
        [&](const ElementBlocks& blocks, const BlockKernels& kernels, const BlockTask& task,
            std::int64_t block) { elements.look(model, blocks, kernels, task, block, least); });
    elements.take(least);
  });
}

Watch watch(const Model& model, const Part& part, const State& state,
            std::span<double> stiffening) {
  CHECK_OP(part.n_local(), ==, model.n_local);
  ElementWatch elements(part, {.stiffening = stiffening});
  watch_elements(model, state, elements);
  Watch w = elements.result();
  w.bad_node = first_bad_node(model, part, state);
  w.is_finite = w.bad_node < 0;
  return w;
}

std::int32_t first_bad_node(const Model& model, const Part& part, const State& state) {
  const std::size_t n = 3 * static_cast<std::size_t>(model.n_owned);
  if (are_sane(std::span(state.u).first(n)) && are_sane(std::span(state.v).first(n))) return -1;
  std::size_t k = 0;
  while (is_sane(state.u[k]) && is_sane(state.v[k])) ++k;
  return part.node_global[k / 3];
}

}  // namespace trocar
