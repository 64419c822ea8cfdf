// Greedy: the change of one side that leaves the fewest pinched nodes, again and again.
#include "cutting/cut_mend.h"

#include <algorithm>

#include "cutting/cut_open.h"

namespace trocar {

// Each trial opens the whole patch: as many as cost some milliseconds.
static constexpr std::ptrdiff_t n_element_trials = 300'000;

static bool may_change(const CutSurroundings& around, const CutStroke& stroke,
                       const CutLabels& labels, std::int32_t e) {
  if (labels.side[e] == 0 || labels.kind[e] == CutKind::front ||
      find_element(stroke.opened, around.patch.element[e]) != nullptr)
    return false;
  const auto& across = around.patch.across[e];
  return std::any_of(across.begin(), across.end(),
                     [&](std::int32_t u) { return u >= 0 && labels.side[u] == -labels.side[e]; });
}

// The element at a pinched node whose change helps most; -1 if none helps. `pinched` is set to what
// is left.
static std::int32_t best_change(const CutSurroundings& around, const CutStroke& stroke,
                                CutLabels& labels, std::vector<std::int32_t>& pinched,
                                std::ptrdiff_t& n_trials) {
  std::int32_t best = -1;
  std::vector<std::int32_t> best_pinched = pinched;
  for (const std::int32_t e : around.patch.star(pinched.front())) {
    if (n_trials <= 0 || !may_change(around, stroke, labels, e)) continue;
    --n_trials;
    labels.side[e] = static_cast<std::int8_t>(-labels.side[e]);
    std::vector<std::int32_t> left = pinched_nodes(around, labels);
    labels.side[e] = static_cast<std::int8_t>(-labels.side[e]);
    if (left.size() >= best_pinched.size()) continue;
    best = e;
    best_pinched = std::move(left);
  }
  pinched = std::move(best_pinched);
  return best;
}

void mend_labels(const CutSurroundings& around, const CutStroke& stroke, CutLabels& labels) {
  std::ptrdiff_t n_trials = 20 + n_element_trials / std::max(1, around.patch.n_elements());
  std::vector<std::int32_t> pinched = pinched_nodes(around, labels);
  std::vector<std::int32_t> hopeless;  // ascending
  while (!pinched.empty() && n_trials > 0) {
    const std::int32_t node = pinched.front();
    const std::int32_t e = best_change(around, stroke, labels, pinched, n_trials);
    if (e >= 0)
      labels.side[e] = static_cast<std::int8_t>(-labels.side[e]);
    else
      hopeless.insert(std::lower_bound(hopeless.begin(), hopeless.end(), node), node);
    std::erase_if(pinched, [&](std::int32_t i) {
      return std::binary_search(hopeless.begin(), hopeless.end(), i);
    });
  }
}

}  // namespace trocar
