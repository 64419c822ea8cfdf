// Looks at all elements and owned nodes; the least values do not depend on the order in which
// threads find them.
#include "solver/watch.h"

#include <cmath>

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

bool is_sane(const double* x, std::size_t n) {
  bool all = true;
  for (std::size_t k = 0; k < n; ++k) all = all & is_sane(x[k]);
  return all;
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
  if (is_sane(state.u.data(), n) && is_sane(state.v.data(), n)) return -1;
  std::size_t k = 0;
  while (is_sane(state.u[k]) && is_sane(state.v[k])) ++k;
  return part.node_global[k / 3];
}

}  // namespace trocar
