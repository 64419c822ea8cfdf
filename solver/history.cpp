#include "solver/history.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/elementary.h"
#include "solver/hourglass_history.h"
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

namespace {

// Numbers of an element.
struct HistoryWidths {
  int of_points = 0, of_hourglass = 0;
  int sum() const { return of_points + of_hourglass; }
};

HistoryWidths history_widths(const ElementBlocks& blocks) {
  if (blocks.prony.empty()) return {};
  const int n_branches = static_cast<int>(blocks.prony.size());
  const int n_points = kernels_for(kernels_of(Simd::scalar), blocks).element.n_points;
  const bool has_hourglass = has_hourglass_forces(blocks.formulation);
  return {n_points * history_of_point(n_branches),
          has_hourglass ? history_of_hourglass(n_branches) : 0};
}

}  // namespace

int history_width(const ElementBlocks& blocks) {
  return history_widths(blocks).sum();
}

std::int64_t place_history(std::vector<ElementBlocks>& lists) {
  std::int64_t next = 0;
  for (ElementBlocks& blocks : lists) {
    blocks.first_history = next;
    next += std::int64_t{blocks.n_blocks} * blocks.lanes * history_width(blocks);
  }
  return next;
}

// The first number from `at` on that is not below `number`: mostly the one there or behind it.
template <class At>
static At find_from(At at, At end, std::int32_t number) {
  for (int k = 0; k < 4 && at != end && *at < number; ++k) ++at;
  return at == end || *at >= number ? at : std::lower_bound(at, end, number);
}

// Calls body(k, first number, widths, lanes between numbers) for each element k of `elements`
// (ascending) that the part has with history.
template <class Body>
static void for_histories(const Model& model, const Part& part,
                          std::span<const std::int32_t> elements, const Body& body) {
  for (const ElementBlocks& blocks : model.blocks) {
    const HistoryWidths widths = history_widths(blocks);
    const int width = widths.sum();
    if (width == 0) continue;
    const auto end = blocks.element_local.begin() + blocks.n_elements;
    auto at = blocks.element_local.begin();
    auto place = part.element_global.begin();
    for (std::size_t k = 0; k < elements.size(); ++k) {
      place = find_from(place, part.element_global.end(), elements[k]);
      if (place == part.element_global.end() || *place != elements[k]) continue;
      const auto local = static_cast<std::int32_t>(place - part.element_global.begin());
      at = find_from(at, end, local);
      if (at == end || *at != local) continue;
      const std::int64_t lane = at - blocks.element_local.begin();
      body(k, blocks.first_history + first_of_lane(lane, blocks.lanes, width), widths,
           blocks.lanes);
    }
  }
}

std::vector<double> copy_history(const Model& model, const Part& part, const State& state,
                                 std::span<const std::int32_t> elements) {
  std::vector<double> copy;
  for_histories(model, part, elements,
                [&](std::size_t k, std::int64_t first, const HistoryWidths& widths, int lanes) {
                  copy.push_back(elements[k]);
                  copy.push_back(widths.of_points);
                  copy.push_back(widths.of_hourglass);
                  for (int j = 0; j < widths.sum(); ++j)
                    copy.push_back(state.history[first + j * lanes]);
                });
  return copy;
}

std::vector<double> copy_history(const Model& model, const Part& part, const State& state) {
  return copy_history(model, part, state, part.element_global);
}

ElementOrigins unedited_elements(std::int32_t n) {
  std::vector<std::int32_t> itself(static_cast<std::size_t>(n));
  std::iota(itself.begin(), itself.end(), 0);
  return {itself, itself, std::vector<double>(itself.size(), 1.0)};
}

namespace {

struct HistoryCopy {
  std::int32_t element = 0;
  std::span<const double> of_points, of_hourglass;
};

// Ascending.
std::vector<HistoryCopy> find_copies(std::span<const double> copies) {
  std::vector<HistoryCopy> found;
  while (!copies.empty()) {
    const auto n_points = static_cast<std::size_t>(copies[1]);
    const auto n_hourglass = static_cast<std::size_t>(copies[2]);
    found.push_back({.element = static_cast<std::int32_t>(copies[0]),
                     .of_points = copies.subspan(3, n_points),
                     .of_hourglass = copies.subspan(3 + n_points, n_hourglass)});
    copies = copies.subspan(3 + n_points + n_hourglass);
  }
  std::ranges::sort(found, {}, &HistoryCopy::element);
  return found;
}

// The mean of points where the parent had more, to number[k * lanes], k < width.
void restore_points(std::span<const double> copy, double scale, int width, int lanes,
                    double* number) {
  const int n = static_cast<int>(copy.size());
  CHECK_OP(n % width, ==, 0);
  const double n_parent_points = n / width;  // for each point of this element
  for (int k = 0; k < n; ++k) {
    const double value = scale * copy[k] / n_parent_points;
    double& to = number[k % width * lanes];
    to = k < width ? value : to + value;
  }
}

}  // namespace

void restore_history(const Model& model, const Part& part, std::span<const double> copies,
                     const ElementOrigins& origins, State& state) {
  CHECK_OP(origins.parent.size(), ==, origins.element.size());
  CHECK_OP(origins.scale.size(), ==, origins.element.size());
  const std::vector<HistoryCopy> found = find_copies(copies);
  for_histories(model, part, origins.element,
                [&](std::size_t e, std::int64_t first, const HistoryWidths& widths, int lanes) {
                  const auto copy =
                      std::ranges::lower_bound(found, origins.parent[e], {}, &HistoryCopy::element);
                  if (copy == found.end() || copy->element != origins.parent[e]) return;
                  double* const number = state.history.data() + first;
                  restore_points(copy->of_points, origins.scale[e], widths.of_points, lanes,
                                 number);
                  if (widths.of_hourglass > 0)
                    restore_points(copy->of_hourglass, origins.scale[e], widths.of_hourglass, lanes,
                                   number + widths.of_points * lanes);
                });
}

}  // namespace trocar
