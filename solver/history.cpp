#include "solver/history.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

// The first number from `at` on that is not below `number`: mostly the one there or behind it.
template <class At>
static At find_from(At at, At end, std::int32_t number) {
  for (int k = 0; k < 4 && at != end && *at < number; ++k) ++at;
  return at == end || *at >= number ? at : std::lower_bound(at, end, number);
}

// Calls body(k, first number, width, lanes between numbers) for each element k of `elements`
// (ascending) that the part has with history.
template <class Body>
static void for_histories(const Model& model, const Part& part,
                          std::span<const std::int32_t> elements, const Body& body) {
  for (const ElementBlocks& blocks : model.blocks) {
    const int width = history_width(blocks);
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
      body(k,
           blocks.first_history + lane / blocks.lanes * width * blocks.lanes + lane % blocks.lanes,
           width, blocks.lanes);
    }
  }
}

std::vector<double> copy_history(const Model& model, const Part& part, const State& state,
                                 std::span<const std::int32_t> elements) {
  std::vector<double> copy;
  for_histories(model, part, elements,
                [&](std::size_t k, std::int64_t first, int width, int lanes) {
                  copy.push_back(elements[k]);
                  copy.push_back(width);
                  for (int j = 0; j < width; ++j) copy.push_back(state.history[first + j * lanes]);
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

// (element, where its copy is), ascending.
static std::vector<std::pair<std::int32_t, std::size_t>> find_copies(
    std::span<const double> copies) {
  std::vector<std::pair<std::int32_t, std::size_t>> found;
  for (std::size_t at = 0; at < copies.size(); at += 2 + static_cast<std::size_t>(copies[at + 1]))
    found.emplace_back(static_cast<std::int32_t>(copies[at]), at);
  std::sort(found.begin(), found.end());
  return found;
}

void restore_history(const Model& model, const Part& part, std::span<const double> copies,
                     const ElementOrigins& origins, State& state) {
  CHECK_OP(origins.parent.size(), ==, origins.element.size());
  CHECK_OP(origins.scale.size(), ==, origins.element.size());
  const auto found = find_copies(copies);
  for_histories(
      model, part, origins.element, [&](std::size_t e, std::int64_t first, int width, int lanes) {
        const auto copy = std::lower_bound(found.begin(), found.end(),
                                           std::pair{origins.parent[e], std::size_t{0}});
        if (copy == found.end() || copy->first != origins.parent[e]) return;
        const std::size_t at = copy->second;
        const int n = static_cast<int>(copies[at + 1]);
        CHECK_OP(n % width, ==, 0);
        const double n_parent_points = n / width;  // for each point of this element
        for (int k = 0; k < n; ++k) {
          const double value =
              origins.scale[e] * copies[at + 2 + static_cast<std::size_t>(k)] / n_parent_points;
          double& number = state.history[first + k % width * lanes];
          number = k < width ? value : number + value;
        }
      });
}

}  // namespace trocar
