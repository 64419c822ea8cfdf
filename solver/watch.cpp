// Looks at all elements and owned nodes; the least values do not depend on the order in which
// threads find them.
#include "solver/watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/simd.h"

namespace trocar {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The least value so far; ties go to the lower global number.
struct Least {
  double value = infinity;
  std::int32_t number = -1;

  void take(double other, std::int32_t other_number) {
    if (other < value || (other == value && (number < 0 || other_number < number))) {
      value = other;
      number = other_number;
    }
  }
};

struct LeastOfElements {
  Least step, J;
};

// An element whose deformation is not a number has no stable step and counts as inverted.
void take_element(double undeformed_step, double J, double stiffening, std::int32_t global,
                  LeastOfElements& least) {
  const bool is_sound = std::isfinite(J) && stiffening < infinity;
  least.step.take(is_sound ? undeformed_step / std::sqrt(stiffening) : 0, global);
  least.J.take(is_sound ? J : -infinity, global);
}

constexpr std::int64_t batch_blocks = 16;

// Calls body(lane, element) for those of n blocks from `first` on that are not padding.
template <class Body>
void for_elements(const ElementBlocks& blocks, std::int64_t first, std::int64_t n,
                  const Body& body) {
  const std::int64_t n_lanes = std::min(n * blocks.lanes, blocks.n_elements - first * blocks.lanes);
  for (std::int64_t lane = 0; lane < n_lanes; ++lane)
    body(lane, blocks.element_local[first * blocks.lanes + lane]);
}

void take_blocks(const Model& model, const Part& part, const State& state,
                 const ElementBlocks& blocks, std::int64_t first, std::int64_t n,
                 std::span<double> growths, LeastOfElements& least) {
  std::array<double, batch_blocks * lanes_of_block<float>> J, stiffening;
  for_strained_blocks(model, blocks, state, first, n,
                      [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
                        const std::int64_t at = (block - first) * blocks.lanes;
                        kernels.law.watch(task, J.data() + at, stiffening.data() + at);
                      });
  for_elements(blocks, first, n, [&](std::int64_t lane, std::int32_t k) {
    const double growth = std::max(1.0, stiffening[lane] / blocks.stiffening_at_rest);
    if (!growths.empty()) growths[static_cast<std::size_t>(k)] = growth;
    take_element(model.element_step[k], J[lane], growth, part.element_global[k], least);
  });
}

LeastOfElements least_of_elements(const Model& model, const Part& part, const State& state,
                                  std::span<double> growths) {
  LeastOfElements all;
  std::mutex mutex;
  parallel_for(count_blocks(model), [&](std::int64_t begin, std::int64_t end) {
    LeastOfElements least;
    for (std::int64_t at = begin; at < end; at += batch_blocks)
      for_block_range(model, at, std::min(end, at + batch_blocks),
                      [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
                        take_blocks(model, part, state, blocks, first, n, growths, least);
                      });
    const std::scoped_lock lock(mutex);
    all.step.take(least.step.value, least.step.number);
    all.J.take(least.J.value, least.J.number);
  });
  return all;
}

// A body that has come so far [m] or so fast [m/s] has blown up; squares of it would overflow.
constexpr double limit = 1e9;

bool is_sane(double x) {
  return std::abs(x) < limit;  // false for NaN
}

}  // namespace

Watch watch(const Model& model, const Part& part, const State& state,
            std::span<double> stiffening) {
  CHECK_OP(part.n_local(), ==, model.n_local);
  CHECK_OP(std::ssize(state.theta), ==, std::int64_t{model.n_local} * model.averages.n_fields);
  const LeastOfElements least = least_of_elements(model, part, state, stiffening);
  Watch w;
  w.stable_step = least.step.value;
  w.stable_element = least.step.number;
  w.least_J = least.J.value;
  w.least_J_element = least.J.number;
  w.bad_node = first_bad_node(model, part, state);
  w.is_finite = w.bad_node < 0;
  return w;
}

std::int32_t first_bad_node(const Model& model, const Part& part, const State& state) {
  for (std::size_t k = 0; k < 3 * static_cast<std::size_t>(model.n_owned); ++k)
    if (!is_sane(state.u[k]) || !is_sane(state.v[k])) return part.node_global[k / 3];
  return -1;
}

}  // namespace trocar
